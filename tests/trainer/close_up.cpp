// The close-up: its eye sees nut and jaw, and its picture covers no panel.
#include "game/trainer/lesson_view.hpp"

#include <doctest/doctest.h>

#include <filesystem>

#include "game/trainer/helped_hand.hpp"
#include "game/view/camera.hpp"
#include "tests/support/folder.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;
using namespace bolt::trainer;

TEST_CASE("Close-up: it is placed at the lower left and covers no panel") {
    const glm::dvec2 picture(1280.0, 720.0);
    const auto place = close_up_rectangle(picture, 1.0F, {});
    REQUIRE(place);
    CHECK(place->low == glm::vec2(12.0F, 720.0F - 12.0F - 180.0F));
    CHECK(place->high == glm::vec2(252.0F, 708.0F));
    // Beside the effort bar at the bottom centre, or above it in a narrow window.
    CHECK(place->high.x < 640.0F - 145.0F);
    const auto narrow = close_up_rectangle({640.0, 480.0}, 1.0F, {});
    REQUIRE(narrow);
    CHECK(narrow->high.y <= 480.0F - 12.0F - 62.0F);
    // It does not cover areas that are already occupied.
    const render::Rectangle below{{0.0F, 650.0F}, {600.0F, 720.0F}}, left{{0.0F, 300.0F}, {100.0F, 720.0F}};
    const auto above = close_up_rectangle(picture, 1.0F, {&below, 1});
    REQUIRE(above);
    CHECK(above->high.y <= below.low.y);
    CHECK_FALSE(close_up_rectangle(picture, 1.0F, {&left, 1}));
    // A small window has a small close-up.
    const auto small = close_up_rectangle({320.0, 180.0}, 1.0F, {});
    REQUIRE(small);
    CHECK(small->high.y - small->low.y < 0.3F * 180.0F);
}

// Visibility is computed from the contact obstacles, for loose and for tight joints, over a pull of 60°.
TEST_CASE(
    "Close-up: on every nut of the reducer the eye at the wrench sees nut and jaw, the eye at the fingers "
    "the nut") {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    for (const lesson::Task task : {lesson::Task::tighten, lesson::Task::loosen}) {
        session::LessonOptions options;
        options.task = task;
        options.obstacles = session::ObstacleUse::required;
        auto begun = session::LessonSession::begin(trainer_test::assembly("zq350"), options, file);
        REQUIRE(begun);
        const servo::Setup& setup = (*begun)->setup();
        const servo::State& state = (*begun)->state();
        REQUIRE(setup.nuts.size() == 12);
        const bool loosens = task == lesson::Task::loosen;
        const Pose rest{Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)};
        motion::VisibilityModel sight;
        for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
            const Vec3 nut = servo::nut_centre(setup.nuts[i], state.joints[i].nut.angle);
            view::ViewTarget of{setup, &*state.tool_contact, i, nut, std::nullopt};
            const Pose tool = wrench_pose_on_nut(rest, setup, state, i, loosens);
            const view::CloseUpEye fingers = view::close_up_eye(of, tool, 0.0, sight);
            of.wrench = tool;
            const view::CloseUpEye wrench =
                view::close_up_eye(of, tool, to_radians(loosens ? 60.0 : -60.0), sight);
            // Recompute the visibility independently, also in the middle of the pull.
            const double first = view::visibility_from(of, sight, tool * wrench.position);
            const Quat half = glm::angleAxis(to_radians(loosens ? 30.0 : -30.0), setup.nuts[i].axis);
            const Pose later{tool.position, half * tool.orientation};
            of.wrench = later;
            const double then = view::visibility_from(of, sight, later * wrench.position);
            MESSAGE((*begun)->assembly().joints[i].design.id << (loosens ? " tight: " : " loose: ")
                                                             << "wrench " << first << ", " << then
                                                             << ", fingers " << fingers.visibility);
            CHECK(first >= 0.6);
            CHECK(then >= 0.6);
            CHECK(wrench.visibility >= 0.6);
            CHECK(fingers.visibility >= 0.6);
            // The eye is on the side from which the jaw approaches, whichever face of the wrench is up.
            CHECK(glm::dot(tool * wrench.position - nut, setup.nuts[i].axis) >
                  0.5 * glm::length(wrench.position));
        }
    }
    std::filesystem::remove(file);
}
