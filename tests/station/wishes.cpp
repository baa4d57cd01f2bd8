// What whoever shows a station wishes of it: pauses, marks, ways back, the wrench and the hand.
#include "tests/station/rig.hpp"

using namespace bolt;
using namespace bolt::station;
using test::nothing;
using test::on_nut;
using test::Rig;
using test::with_arm;

TEST_CASE("in a pause nothing is felt and nothing moves; afterwards forces come back over the ramp") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    const Pose before = rig.tool();
    const std::uint64_t ticks = rig.servo.tick;
    const auto rests = [&](int count) {
        for (int i = 0; i < count; ++i) {
            ++rig.heard.mover.number;
            CHECK(nothing(pause(rig.layout, rig.setup, rig.state, rig.heard).mover));
        }
    };
    rests(100);
    rig.hand().position += Vec3(0.0, 0.3, 0.0);  // the arm is laid down
    rests(100);
    CHECK(rig.servo.tick == ticks);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    SUBCASE("and goes on") {
        double last = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().mover.force);
            CHECK(now - last < 0.1);
            last = now;
        }
        CHECK(last > 1.0);
        CHECK(glm::length(rig.tool().position - before.position) < 1e-9);
        CHECK(rig.servo.output.watchdog.counts[static_cast<std::size_t>(force::Fault::jumped)] == 0);
    }
    SUBCASE("a stop that was pressed meanwhile counts") {
        rig.layout.mover_buttons.stop = 16;
        rig.heard.mover.sample.buttons = 16;
        rests(5);
        rig.heard.mover.sample.buttons = 0;
        rests(5);
        rig.ticks(3);
        CHECK(rig.state.output.fault == force::Fault::stopped);
    }
}

TEST_CASE("marks are kept one a tick, a way back is asked for until it is granted, and then no more") {
    Layout layout;
    layout.mover = test::puck();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(10);
    CHECK(rig.servo.marked == 0);
    rig.heard.wishes.marks = 3;
    rig.ticks(2);
    CHECK(rig.servo.marked == 2);
    rig.ticks(10);
    CHECK(rig.servo.marked == 3);
    // As long as the tool is beside the nut nothing leaps.
    const Pose away = rig.tool();
    rig.heard.wishes.put.position = servo::nut_centre(rig.setup.nuts[0], 0.0) + Vec3(0.0, 0.05, 0.0);
    rig.heard.wishes.put_number = 1;
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    CHECK(glm::length(rig.tool().position - rig.heard.wishes.put.position) < 1e-9);
    rig.heard.wishes.back = 2;
    rig.heard.wishes.back_number = 7;
    rig.ticks(20);
    CHECK(rig.servo.marked == 3);
    CHECK(rig.state.input.undo == 2);
    rig.heard.wishes.put = away;
    rig.heard.wishes.put_number = 2;
    rig.ticks(20);
    CHECK(rig.servo.marked == 2);
    CHECK(rig.state.input.undo == 0);
    // The same once more has another number.
    rig.heard.wishes.back_number = 8;
    rig.ticks(20);
    CHECK(rig.servo.marked == 1);
}

TEST_CASE(
    "a wrench is taken where it lies, stays on the nut that the hand lets go of it on, and else goes back") {
    Layout layout = with_arm();
    Rig rig(layout);
    const servo::NutPlace& nut = rig.setup.nuts[0];
    const servo::ToolPose on =
        servo::pose_of(test::tool_at(nut, servo::nut_centre(nut, 0.0), rig.setup.wrench.head_angle));
    const Pose rest{Vec3(0.1, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.heard.wishes.rest = rest;
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.lies);
    CHECK(rig.state.lies->position == rest.position);
    rig.heard.wishes.grip = servo::Grip::wrench;
    rig.tick();
    CHECK_FALSE(rig.state.lies);
    CHECK(glm::length(rig.tool().position - rest.position) < 1e-9);
    // From there it follows the hand.
    rig.hand().position += Vec3(0.0, 0.0, 1e-3);
    rig.tick();
    CHECK(glm::length(rig.tool().position - rest.position) == doctest::Approx(1e-3));
    rig.heard.wishes.put = {on.position, on.orientation};
    rig.heard.wishes.put_number = 1;
    rig.ticks(700);
    REQUIRE(rig.state.output.joint == 0);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.lies);
    CHECK(glm::length(rig.state.lies->position - on.position) < 1e-3);
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.tick();
    rig.heard.wishes.grip = servo::Grip::wrench;
    rig.tick();
    CHECK(glm::length(rig.tool().position - on.position) < 1e-3);
    // Let go of in the air.
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.ticks(5);
    REQUIRE(rig.state.output.joint < 0);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(2);
    CHECK(rig.state.lies->position == rest.position);
}

TEST_CASE("a gloved hand that lets go stays where it is: what moves on is its fingertips") {
    Layout layout = with_arm();
    layout.wrist = Pose{Vec3(0.12, 0.02, -0.03), rotation(Vec3(0.1, 0.2, 1.5))};
    Rig rig(layout);
    rig.heard.wishes.rest = Pose{Vec3(0.0, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.heard.wishes.bare_wrist = Pose{Vec3(0.02, 0.1, 0.05), rotation(Vec3(-1.0, 0.2, 0.3))};
    const auto wrist = [&] {
        return in_hand(layout, rig.setup, rig.state, rig.heard.wishes) * *layout.wrist;
    };
    rig.heard.hand = servo::Grip::none;
    rig.ticks(5);
    const Pose bare = rig.tool() * *rig.heard.wishes.bare_wrist;
    CHECK(glm::distance(wrist().position, bare.position) < 1e-12);
    rig.heard.hand = servo::Grip::wrench;
    rig.ticks(5);
    CHECK(glm::distance(rig.tool().position, rig.heard.wishes.rest->position) < 1e-9);
    const Pose holding = wrist();
    CHECK(glm::distance(holding.position, (rig.tool() * *layout.wrist).position) < 1e-12);
    rig.heard.hand = servo::Grip::none;
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, holding.position) < 1e-9);
    CHECK(std::abs(glm::dot(wrist().orientation, holding.orientation)) > 1.0 - 1e-9);
    CHECK(glm::distance(rig.tool().position, rig.heard.wishes.rest->position) > 0.01);
    // Beside the wrench that lies there it has its hand about the handle.
    rig.heard.wishes.put = *rig.state.lies * Pose{Vec3(0.1, 0.03, 0.02), rotation(Vec3(0.3, 0.0, 0.0))};
    rig.heard.wishes.put_number = 1;
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, (*rig.state.lies * *layout.wrist).position) < 1e-9);
}

TEST_CASE("a window that hangs holds no dead-man, a button of the device does") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    rig.heard.wishes.lasts = 0.5;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    rig.heard.age = 0.51;
    CHECK(nothing(rig.ticks(25).mover));
    CHECK_FALSE(rig.state.input.enabled);
    rig.heard.mover.sample.buttons = 1;
    rig.tick();
    CHECK(rig.state.input.enabled);
    rig.heard.mover.sample.buttons = 0;
    rig.heard.age = 0.0;
    rig.tick();
    CHECK(rig.state.input.enabled);
}
