// Devices that move the tool by rates or rotations: puck, keys, wheel.
#include <utility>

#include "tests/station/test_station.hpp"

using namespace bolt;
using namespace bolt::station;
using test::nothing;
using test::on_nut;
using test::Rig;
using test::with_arm;

TEST_CASE("Puck: the tool moves at the puck's rate while that is valid, and stops at obstacles") {
    DeviceLayout layout;
    layout.mover = test::puck();
    layout.workspace.rotation = rotation(Vec3(0, 0, pi / 2));
    Rig rig(layout);
    rig.inputs.controls.grip = servo::Grip::none;
    rig.inputs.mover.sample.velocity = Vec3(0.1, 0, 0);
    rig.inputs.mover.sample.angular_velocity = Vec3(0, 0, 0.5);
    rig.ticks(1000);
    CHECK(glm::length(rig.tool().position - Vec3(0, 0.1, 0)) < 1e-4);
    CHECK(rotation_vector(rig.tool().orientation).z == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(rig.state.output.fault == force::Fault::none);
    SUBCASE("a puck that falls silent while pushed moves the tool for velocity_timeout") {
        rig.mover_speaks = false;
        rig.ticks(2000);
        CHECK(rig.tool().position.y - 0.1 == doctest::Approx(0.1 * velocity_timeout).epsilon(0.02));
    }
    SUBCASE("a puck that is lost while pushed stops the tool") {
        rig.inputs.mover.usable = false;
        rig.ticks(2000);
        CHECK(rig.tool().position.y == doctest::Approx(0.1).epsilon(1e-3));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
    SUBCASE("the clutch stops the tool") {
        rig.inputs.controls.clutch = true;
        rig.ticks(2000);
        CHECK(rig.tool().position.y == doctest::Approx(0.1).epsilon(1e-3));
    }
    SUBCASE("the hand leads a blocked tool by at most max_ahead") {
        const Pose held = rig.state.output.constrained_tool;
        rig.inputs.mover.sample.velocity = Vec3(0.3, 0, 0);
        for (int i = 0; i < 1000; ++i) {
            ++rig.inputs.mover.number;
            read_inputs(rig.layout, rig.setup, rig.state, rig.inputs);
            rig.state.output.constrained_tool = held;
        }
        CHECK(glm::length(rig.tool().position - held.position) == doctest::Approx(max_ahead).epsilon(0.05));
        const Vec3 turned = turn_between(held.orientation, rig.tool().orientation);
        CHECK(glm::length(turned) <= max_angle_ahead * 1.01);
    }
}

TEST_CASE("Wheel: clockwise as the user sees it tightens, at a left-hand thread it loosens, for any axis") {
    using joint::ThreadDirection;
    for (const auto& row : {std::pair{Vec3(0, 0, -1), ThreadDirection::right},
                            {Vec3(0, 0, 1), ThreadDirection::right},
                            {Vec3(0, 1, 0), ThreadDirection::right},
                            {Vec3(0, -1, 0), ThreadDirection::right},
                            {Vec3(0, 0, -1), ThreadDirection::left},
                            {Vec3(0, 1, 0), ThreadDirection::left}}) {
        const auto& axis = row.first;
        const auto& thread = row.second;
        CAPTURE(axis.y);
        CAPTURE(axis.z);
        DeviceLayout layout;
        layout.mover = test::puck();
        layout.wheel = test::wheel_of(10.0, axis);
        Rig rig = on_nut(layout, thread);
        // The user looks along −z, or down. Clockwise is right-handed about the viewing direction.
        const double with_clock = axis.y + axis.z < 0.0 ? 1.0 : -1.0;
        const double tightens = thread == ThreadDirection::left ? -with_clock : with_clock;
        DeviceCommands answer;
        for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 100.0; ++i) {
            rig.inputs.wheel.sample.angle += tightens * 1e-3;
            answer = rig.tick();
        }
        REQUIRE(rig.state.output.wrench_torque > 99.0);
        CHECK(rig.state.output.nut_angle > 0.5);
        // The wheel renders the nut's torque, scaled to its motor, against its rotation.
        const double felt = glm::dot(answer.wheel.torque, axis) * -tightens;
        CHECK(
            felt ==
            doctest::Approx(rig.state.output.wrench_torque * rig.setup.torque_rendering.scale).epsilon(0.02));
        CHECK(glm::length(answer.wheel.torque) <= 10.0);
        CHECK(nothing(answer.mover));
        CHECK(rig.state.output.fault == force::Fault::none);

        // After 18 ms without a sample of the wheel the torque is zero.
        rig.wheel_speaks = false;
        CHECK(nothing(rig.ticks(18).wheel));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
}

TEST_CASE("Station: a silent arm is released and the wheel keeps its torque; a silent wheel is released") {
    DeviceLayout layout = with_arm();
    layout.wheel = test::wheel_of(10.0);
    for (const bool arm_falls_mute : {true, false}) {
        Rig rig = on_nut(layout);
        rig.hand().position.z += 2e-3;
        for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 50.0; ++i) {
            rig.inputs.wheel.sample.angle += 1e-3;
            rig.tick();
        }
        DeviceCommands answer = rig.tick();
        REQUIRE(rig.state.output.wrench_torque > 40.0);
        REQUIRE(glm::length(answer.mover.force) > 1.0);
        REQUIRE(glm::length(answer.wheel.torque) > 0.5);
        (arm_falls_mute ? rig.mover_speaks : rig.wheel_speaks) = false;
        answer = rig.ticks(18);
        if (arm_falls_mute) CHECK(nothing(answer.mover));
        CHECK(nothing(answer.wheel) == !arm_falls_mute);
    }
}

TEST_CASE("Wheel: without an engaged nut it turns nothing, and that rotation is discarded") {
    DeviceLayout layout;
    layout.mover = test::puck();
    layout.wheel = test::wheel_of(10.0);
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(700);
    const Pose before = rig.tool();
    for (int i = 0; i < 1000; ++i) {
        rig.inputs.wheel.sample.angle += 0.01;
        CHECK(nothing(rig.tick().wheel));
    }
    CHECK(rig.tool().orientation == before.orientation);
    CHECK(rig.tool().position == before.position);

    Rig on = on_nut(layout);
    const Pose there = on.tool();
    ++on.inputs.wheel.connection_number;  // replugged: its count restarts
    on.inputs.wheel.sample.angle = 40.0;
    on.ticks(5);
    CHECK(glm::length(turn_between(there.orientation, on.tool().orientation)) < 1e-9);
    CHECK(on.state.output.joint == 0);
}

TEST_CASE("Puck: the tool approaches the nut by itself, descends with it, and leaves it when pushed away") {
    DeviceLayout layout;
    layout.mover = test::puck();
    const servo::Setup setup = test::two_joints(limits_of(layout));
    const servo::NutGeometry& nut = setup.nuts[0];
    layout.home = {servo::nut_centre(nut, 0.0) + Vec3(0.04, 0.09, 0.03), rotation(Vec3(-0.5 * pi, 0.0, 0.0))};
    Rig rig(layout);
    rig.inputs.controls.grip = servo::Grip::fingers;
    rig.ticks(1500);
    CHECK(rig.state.output.joint < 0);
    CHECK(glm::length(rig.tool().position - layout.home.position) < 1e-9);
    rig.inputs.controls.approach_joint = 0;
    rig.ticks(4000);
    REQUIRE(rig.state.output.joint == 0);
    // Spun clockwise, seen from above.
    rig.inputs.mover.sample.angular_velocity = Vec3(0.0, -2.0, 0.0);
    rig.ticks(500);
    CHECK(rig.state.output.nut_angle == doctest::Approx(finger_velocity_factor * 1.0).epsilon(0.1));
    CHECK(rig.state.output.joint == 0);
    CHECK(glm::length(rig.tool().position - servo::nut_centre(nut, rig.state.output.nut_angle)) < 5e-3);
    rig.inputs.mover.sample.angular_velocity = Vec3(0.0);
    rig.inputs.mover.sample.velocity = Vec3(0.0, 0.2, 0.0);
    rig.ticks(800);
    CHECK(rig.state.output.joint < 0);
    CHECK(rig.tool().position.y > servo::nut_centre(nut, rig.state.output.nut_angle).y + 0.05);
    SUBCASE("a device that moves the tool itself does not approach by itself") {
        Rig arm(with_arm());
        arm.inputs.controls.approach_joint = 0;
        arm.ticks(2000);
        CHECK(glm::length(arm.tool().position - arm.layout.home.position) < 1e-12);
    }
}

TEST_CASE("Puck: a wrench turns more slowly the more torque it transmits") {
    DeviceLayout layout;
    layout.mover = test::puck();
    Rig rig = on_nut(layout);
    rig.inputs.mover.sample.angular_velocity = Vec3(0.0, -1.0, 0.0);
    double fastest = 0.0, last = 0.0;
    for (int i = 0; i < 60'000 && rig.state.output.wrench_torque < 150.0; ++i) {
        rig.tick();
        if (rig.state.output.wrench_torque > 50.0)
            fastest = std::max(fastest, rig.state.output.wrench_torque - last);
        last = rig.state.output.wrench_torque;
    }
    CHECK(rig.state.output.joint == 0);
    CHECK(last >= 150.0);
    CHECK(fastest < 0.2);  // N·m per millisecond, slow enough to stop at the target
}
