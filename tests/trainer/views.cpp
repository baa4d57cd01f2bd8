// The view found for a nut shows the nut, the jaw and the hand at work.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "game/scene/postures.hpp"
#include "game/trainer/helped_hand.hpp"
#include "game/view/camera.hpp"
#include "tests/support/folder.hpp"
#include "tests/trainer/player.hpp"

using namespace bolt;

TEST_CASE("View: a point is inside or outside a part of the picture") {
    view::Orbit orbit;  // from +Z at 1 m
    const double up = std::tan(0.5 * orbit.fov);
    CHECK(view::is_in_picture(orbit, {0.0, 0.85 * up, 0.0}, 2.0));
    CHECK_FALSE(view::is_in_picture(orbit, {0.0, 0.9 * up, 0.0}, 2.0));
    CHECK(view::is_in_picture(orbit, {1.7 * up, 0.0, 0.0}, 2.0));
    CHECK_FALSE(view::is_in_picture(orbit, {1.7 * up, 0.0, 0.0}, 1.0));
    CHECK_FALSE(view::is_in_picture(orbit, {0.0, 0.0, 1.5}, 1.0));  // behind the eye
    CHECK(view::is_in_picture(orbit, {0.7 * up, 0.55 * up, 0.0}, 2.0, view::open_middle));
    CHECK_FALSE(view::is_in_picture(orbit, {0.75 * up, 0.0, 0.0}, 2.0, view::open_middle));
    CHECK_FALSE(view::is_in_picture(orbit, {0.0, 0.65 * up, 0.0}, 2.0, view::open_middle));
}

TEST_CASE("View: for every nut of the reducer it contains the wrist and still shows nut and jaw well") {
    const test::Folder folder;
    const auto file = folder / "lesson.boltwright";
    session::LessonOptions options;
    options.obstacles = session::ObstacleUse::required;
    auto begun = session::LessonSession::begin(trainer_test::assembly("zq350"), options, file);
    REQUIRE(begun);
    const servo::Setup& setup = (*begun)->setup();
    const servo::State& state = (*begun)->state();
    const Pose rest{Vec3(0.0, 0.05, 0.35), Quat(1, 0, 0, 0)};
    const scene::Postures postures =
        scene::make_postures(&state.tool_contact->wrench, setup.wrench.handle_length);
    const Vec3 shoulder(0.6, 0.6, 0.7);
    motion::VisibilityModel sight;
    int outside_before = 0;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        const Vec3 nut = servo::nut_centre(setup.nuts[i], state.joints[i].nut.angle);
        view::ViewTarget of{setup, &*state.tool_contact, i, nut,
                            trainer::wrench_pose_on_nut(rest, setup, state, i, false)};
        const std::size_t posture =
            scene::natural_handle_posture(postures, *of.wrench, Vec3(0, 1, 0), shoulder);
        const Vec3 wrist = *of.wrench * postures.on_handle.at(posture).position[hand::wrist];
        view::Orbit from;
        from.pitch = to_radians(30.0);
        const view::Orbit without = view::find_view(of, sight, from);
        if (!view::is_in_picture(without, wrist, of.aspect)) ++outside_before;
        of.wrist = wrist;
        const view::Orbit found = view::find_view(of, sight, from);
        const double seen = view::visibility_from(of, sight, Vec3(view::viewpoint_of(found).eye));
        MESSAGE((*begun)->assembly().joints[i].design.id << " seen " << seen << " from " << found.distance
                                                         << " m");
        CHECK(view::is_in_picture(found, nut, of.aspect, view::open_middle));
        CHECK(view::is_in_picture(found, wrist, of.aspect));
        CHECK(seen >= view::sufficient_visibility);
        CHECK(found.distance < 0.8);
    }
    CHECK(outside_before > 0);  // verifies that the wrist changes the view
    MESSAGE(outside_before << " of 12 wrists were outside the view without this");
    begun->reset();
    std::filesystem::remove(file);
}
