// Commands to a station: pause, checkpoints, undo, and the placement of wrench and hand.
#include "tests/station/test_station.hpp"

namespace station_commands_test {

using namespace bolt;
using namespace bolt::station;
using test::nothing;
using test::on_nut;
using test::Rig;
using test::with_arm;

TEST_CASE("Station: a pause renders no force and moves nothing; afterwards forces ramp up") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    const Pose before = rig.tool();
    const std::uint64_t ticks = rig.servo.tick;
    const auto rests = [&](int count) {
        for (int i = 0; i < count; ++i) {
            ++rig.inputs.mover.number;
            CHECK(nothing(pause_tick(rig.layout, rig.setup, rig.state, rig.inputs).mover));
        }
    };
    rests(100);
    rig.hand().position += Vec3(0.0, 0.3, 0.0);  // the device's arm is put down
    rests(100);
    CHECK(rig.servo.tick == ticks);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    SUBCASE("the pause ends") {
        double last = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().mover.force);
            CHECK(now - last < 0.1);
            last = now;
        }
        CHECK(last > 1.0);
        CHECK(glm::length(rig.tool().position - before.position) < 1e-9);
        CHECK(rig.servo.output_stage.watchdog.counts[static_cast<std::size_t>(force::Fault::jumped)] == 0);
    }
    SUBCASE("a stop pressed during the pause is a fault afterwards") {
        rig.layout.mover_buttons.stop = 16;
        rig.inputs.mover.sample.buttons = 16;
        rests(5);
        rig.inputs.mover.sample.buttons = 0;
        rests(5);
        rig.ticks(3);
        CHECK(rig.state.output.fault == force::Fault::stopped);
    }
}

TEST_CASE("Station: a wheel that is reopened in a pause turns the wrench from its new angle") {
    DeviceLayout layout = with_arm();
    layout.wheel = test::wheel_of(10.0);
    Rig rig = on_nut(layout);
    const Pose before = rig.tool();
    rig.wheel_speaks = false;  // a wheel at rest sends nothing
    rig.inputs.wheel.connection_number = 2;
    for (int i = 0; i < 10; ++i) {
        ++rig.inputs.mover.number;
        pause_tick(rig.layout, rig.setup, rig.state, rig.inputs);
    }
    rig.ticks(10);
    rig.inputs.wheel.sample.angle = 1.0;  // the first sample of the new connection
    ++rig.inputs.wheel.number;
    rig.ticks(1);
    CHECK(glm::length(turn_between(before.orientation, rig.tool().orientation)) < 1e-9);
    rig.inputs.wheel.sample.angle = 1.1;
    ++rig.inputs.wheel.number;
    rig.ticks(1);
    CHECK(glm::length(turn_between(before.orientation, rig.tool().orientation)) == doctest::Approx(0.1));
}

TEST_CASE(
    "Station commands: checkpoints are saved one a tick, a restore stays pending until the servo permits "
    "it") {
    DeviceLayout layout;
    layout.mover = test::puck();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(10);
    CHECK(rig.servo.checkpoint_count == 0);
    rig.commands = {SaveCheckpoint{}, SaveCheckpoint{}, SaveCheckpoint{}};
    rig.ticks(2);
    CHECK(rig.servo.checkpoint_count == 2);
    rig.ticks(10);
    CHECK(rig.servo.checkpoint_count == 3);
    // The servo permits no undo while the tool is beside the nut.
    const Pose away = rig.tool();
    const Pose near{servo::nut_centre(rig.setup.nuts[0], 0.0) + Vec3(0.0, 0.05, 0.0), Quat(1, 0, 0, 0)};
    rig.commands = {PlaceTool{near}};
    rig.inputs.controls.grip = servo::Grip::none;
    rig.ticks(5);
    CHECK(glm::length(rig.tool().position - near.position) < 1e-9);
    rig.commands = {RestoreCheckpoint{2}};
    rig.ticks(20);
    CHECK(rig.servo.checkpoint_count == 3);
    CHECK(rig.state.input.checkpoint_action == 2);
    SUBCASE("each command is executed once") {
        rig.commands = {PlaceTool{away}};
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 2);
        CHECK(rig.state.input.checkpoint_action == 0);
        rig.commands = {AmendRestore{2}};  // too late: the restore is done
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 2);
        rig.commands = {RestoreCheckpoint{2}};
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 1);
    }
    SUBCASE("amended to a later checkpoint") {
        rig.commands = {AmendRestore{1}, PlaceTool{away}};
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 3);
        CHECK(rig.state.input.checkpoint_action == 0);
    }
    SUBCASE("cancelled") {
        rig.commands = {AmendRestore{0}, PlaceTool{away}};
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 3);
    }
    SUBCASE("amended to more steps than there are checkpoints: ignored, and nothing is saved") {
        rig.commands = {AmendRestore{servo::save_checkpoint}, PlaceTool{away}};
        rig.ticks(20);
        CHECK(rig.servo.checkpoint_count == 2);
    }
}

TEST_CASE("Station commands: those of a pause are executed in the first tick after it") {
    DeviceLayout layout;
    layout.mover = test::puck();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(10);
    const Pose before = rig.tool();
    const std::vector<StationCommand> sent{PlaceTool{Pose{Vec3(0.3, 0.4, 0.0), Quat(1, 0, 0, 0)}},
                                           SaveCheckpoint{}};
    rig.inputs.commands = sent;
    pause_tick(rig.layout, rig.setup, rig.state, rig.inputs);
    CHECK(rig.tool().position == before.position);
    rig.tick();
    CHECK(rig.tool().position == Vec3(0.3, 0.4, 0.0));
    CHECK(rig.servo.checkpoint_count == 1);
}

TEST_CASE(
    "Station: a wrench is taken from its rest pose, stays on a nut when released there, and else returns to "
    "it") {
    DeviceLayout layout = with_arm();
    Rig rig(layout);
    const servo::NutGeometry& nut = rig.setup.nuts[0];
    const servo::ToolPose on =
        servo::tool_pose(test::tool_at(nut, servo::nut_centre(nut, 0.0), rig.setup.wrench.head_angle));
    const Pose rest{Vec3(0.1, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.inputs.controls.wrench_rest_pose = rest;
    rig.inputs.controls.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.resting_wrench);
    CHECK(rig.state.resting_wrench->position == rest.position);
    rig.inputs.controls.grip = servo::Grip::wrench;
    rig.tick();
    CHECK_FALSE(rig.state.resting_wrench);
    CHECK(glm::length(rig.tool().position - rest.position) < 1e-9);
    // From there on it follows the hand.
    rig.hand().position += Vec3(0.0, 0.0, 1e-3);
    rig.tick();
    CHECK(glm::length(rig.tool().position - rest.position) == doctest::Approx(1e-3));
    rig.commands = {PlaceTool{Pose{on.position, on.orientation}}};
    rig.ticks(700);
    REQUIRE(rig.state.output.joint == 0);
    rig.inputs.controls.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.resting_wrench);
    CHECK(glm::length(rig.state.resting_wrench->position - on.position) < 1e-3);
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.tick();
    rig.inputs.controls.grip = servo::Grip::wrench;
    rig.tick();
    CHECK(glm::length(rig.tool().position - on.position) < 1e-3);
    // Released in the air.
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.ticks(5);
    REQUIRE(rig.state.output.joint < 0);
    rig.inputs.controls.grip = servo::Grip::none;
    rig.ticks(2);
    CHECK(rig.state.resting_wrench->position == rest.position);
}

TEST_CASE(
    "Station: a gloved hand that releases the wrench stays in place; then the device moves its fingertips") {
    DeviceLayout layout = with_arm();
    layout.wrist = Pose{Vec3(0.12, 0.02, -0.03), rotation(Vec3(0.1, 0.2, 1.5))};
    Rig rig(layout);
    rig.inputs.controls.wrench_rest_pose = Pose{Vec3(0.0, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.inputs.controls.empty_hand_wrist = Pose{Vec3(0.02, 0.1, 0.05), rotation(Vec3(-1.0, 0.2, 0.3))};
    const auto wrist = [&] {
        return tool_of_gloved_hand(layout, rig.setup, rig.state, rig.inputs.controls) * *layout.wrist;
    };
    rig.inputs.hand_grip = servo::Grip::none;
    rig.ticks(5);
    const Pose bare = rig.tool() * *rig.inputs.controls.empty_hand_wrist;
    CHECK(glm::distance(wrist().position, bare.position) < 1e-12);
    rig.inputs.hand_grip = servo::Grip::wrench;
    rig.ticks(5);
    CHECK(glm::distance(rig.tool().position, rig.inputs.controls.wrench_rest_pose->position) < 1e-9);
    const Pose holding = wrist();
    CHECK(glm::distance(holding.position, (rig.tool() * *layout.wrist).position) < 1e-12);
    rig.inputs.hand_grip = servo::Grip::none;
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, holding.position) < 1e-9);
    CHECK(std::abs(glm::dot(wrist().orientation, holding.orientation)) > 1.0 - 1e-9);
    CHECK(glm::distance(rig.tool().position, rig.inputs.controls.wrench_rest_pose->position) > 0.01);
    // Placed at the rest pose of the wrench, the hand is around its handle.
    rig.commands = {
        PlaceTool{*rig.state.resting_wrench * Pose{Vec3(0.1, 0.03, 0.02), rotation(Vec3(0.3, 0.0, 0.0))}}};
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, (*rig.state.resting_wrench * *layout.wrist).position) < 1e-9);
}

TEST_CASE("Station: the dead-man switch of a window that hangs expires, a device's button does not") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    rig.inputs.controls.dead_man_timeout = 0.5;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    rig.inputs.controls_age = 0.51;
    CHECK(nothing(rig.ticks(25).mover));
    CHECK_FALSE(rig.state.input.dead_man);
    rig.inputs.mover.sample.buttons = 1;
    rig.tick();
    CHECK(rig.state.input.dead_man);
    rig.inputs.mover.sample.buttons = 0;
    rig.inputs.controls_age = 0.0;
    rig.tick();
    CHECK(rig.state.input.dead_man);
}

}  // namespace station_commands_test
