// A lesson in a room with an arm whose frame is registered to the room: the picture is where the arm feels.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/room/immersive_driver.hpp"
#include "tests/station/virtual_time_station.hpp"

namespace registered_arm_test {

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

constexpr VkExtent2D small_eye{160, 120};
const Pose arm_in_room{{0.3, 0.9, -0.2}, rotation({0.0, 0.4, 0.0})};

// A lesson with an arm and the registration `registered`.
struct RegisteredArm {
    test::VirtualTimeStation* bench = nullptr;
    std::optional<HeadlessTrainer> driver;

    explicit RegisteredArm(std::optional<content::Registration> registered, double scale = 1.0) {
        AppOptions options = test::options("cover-m8", false);
        options.choice.equipment.hand = HandMode::keyboard;
        content::StationFile& station = options.choice.equipment.station;
        station.arm.emplace().device = "force-dimension:0";
        if (registered) station.registrations.push_back(*registered);
        options.start_station =
            [this, scale](const content::Assembly& assembly, const session::LessonOptions& lesson,
                          const Equipment&, const std::string&,
                          const device::ArmDialog&) -> Result<std::unique_ptr<station_setup::LessonStation>> {
            BOLT_TRY_ASSIGN(auto prepared, session::prepare_session(assembly, lesson));
            auto made = std::make_unique<test::VirtualTimeStation>(std::move(prepared), lesson, scale);
            bench = made.get();
            return made;
        };
        driver.emplace(std::move(options), test::Display{small_eye, 0.3F, 0.02});
        driver->immersive = test::standing_user(small_eye);
        for (int i = 0; i < 8; ++i) frame();
    }
    void frame() {
        if (bench != nullptr) bench->advance(0.02);
        driver->frame();
    }
    [[nodiscard]] const ActiveLesson& lesson() const { return *driver->app().lesson(); }
    [[nodiscard]] bool logged(const char* words) const {
        const std::vector<std::string>& lines = driver->log();
        return std::any_of(lines.begin(), lines.end(),
                           [&](const std::string& line) { return line.find(words) != std::string::npos; });
    }
    // The scene's pose in the room, from the head in both.
    [[nodiscard]] Pose scene_in_room() const {
        return driver->immersive->head * inverse(*lesson().view.head);
    }
};

content::Registration registration() {
    content::Registration one;
    one.pose = arm_in_room;
    one.date = "2026-11-20T10:00:00Z";
    one.rms = 1.2e-3;
    return one;
}

double distance(const Pose& a, const Pose& b) {
    return glm::length(a.position - b.position) + glm::length(turn_between(a.orientation, b.orientation));
}

}  // namespace

TEST_CASE(
    "Registered arm: the scene stands where the arm feels it, in either direction of the registration") {
    for (const bool inverted : {false, true}) {
        content::Registration one = registration();
        if (inverted) {
            std::swap(one.from, one.to);
            one.pose = inverse(one.pose);
        }
        RegisteredArm at(one);
        REQUIRE(at.lesson().view.head);
        const Pose expected = registered_scene(arm_in_room, at.lesson().station->latest.mover_in_assembly);
        CHECK(distance(at.scene_in_room(), expected) < 1e-9);
        CHECK(at.logged("picture and arm are aligned: registered on 2026-11-20T10:00:00Z with 1.2 mm rms"));
        CHECK(!at.driver->app().room()->touch);  // there is no check point
        CHECK(!at.lesson().clock.paused);
        // The arm's directions are those of the room, wherever the user looks.
        REQUIRE(at.lesson().view.heading);
        CHECK(at.lesson().view.heading->w == 1.0);
    }
}

TEST_CASE(
    "Registered arm: without a registration, at another scale or without a floor the scene stands before the "
    "user") {
    Pose before_user;
    {
        const RegisteredArm none(std::nullopt);
        before_user = none.scene_in_room();
        CHECK(distance(before_user, *none.driver->app().room()->workpiece) < 1e-9);
        CHECK(!none.logged("picture and arm"));
    }
    const RegisteredArm scaled(registration(), 1.5);
    CHECK(distance(scaled.scene_in_room(), before_user) < 1e-9);
    CHECK(scaled.logged("picture and arm are not aligned: the scale of the arm is 1.50; expected 1"));
}

TEST_CASE("Registered arm: a registration of a wheel is reported and changes nothing") {
    Pose alone;
    {
        const RegisteredArm none(std::nullopt);
        alone = none.scene_in_room();
        CHECK(!none.logged("is not used"));
    }
    content::Registration wheel = registration();
    wheel.from = content::CoordinateFrame::wheel;
    const RegisteredArm at(wheel);
    CHECK(at.logged("a registration between \"wheel\" and \"room\" is not used"));
    CHECK(distance(at.scene_in_room(), alone) < 1e-9);
}

TEST_CASE("Registered arm: after the workpiece was turned, right is still the user's right") {
    RegisteredArm at(std::nullopt);
    at.driver->immersive->hands.sides[1].active = true;
    at.driver->immersive->hands.sides[1].stick = {1.0F, 0.0F};
    for (int i = 0; i < 2; ++i) at.frame();
    REQUIRE(at.driver->app().room()->turns == 1);
    REQUIRE(at.lesson().view.heading);
    // To the right of the user, in the assembly, and from there into the room.
    const Vec3 right = at.scene_in_room().orientation * (*at.lesson().view.heading * Vec3(1.0, 0.0, 0.0));
    CHECK(glm::length(right - Vec3(1.0, 0.0, 0.0)) < 1e-9);
}

}  // namespace registered_arm_test
