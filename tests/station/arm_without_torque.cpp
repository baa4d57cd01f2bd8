// An arm that renders no torque: its handle stands for the end of the wrench.
#include "tests/station/test_station.hpp"

namespace station_arm_without_torque_test {

using namespace bolt;
using namespace bolt::station;
using test::on_nut;
using test::Rig;

namespace {

// A small arm of the omega class, with its scale fitted as Station::start does.
DeviceLayout small_arm() {
    DeviceLayout layout = test::with_arm();
    layout.mover->limits.torque = 0.0;
    layout.mover->limits.force = 12.0;
    layout.mover->half_workspace = Vec3(0.075);
    layout.workspace.scale = force::fitted_scale(layout.mover->half_workspace, 0.23);
    layout.workspace.power_ratio = 1.0 / layout.workspace.scale;
    return layout;
}

// The position of the device at which the grip is at `point`.
Vec3 device_at(const Rig& rig, const Vec3& point) {
    return (point - rig.state.workspace.centre) / rig.layout.workspace.scale;
}

}  // namespace

TEST_CASE(
    "An arm without torque: its handle is the end of the wrench, with torque or a wheel it is the jaw") {
    DeviceLayout layout = small_arm();
    CHECK(lever_arm_of(layout, 0.23) == 0.23);
    layout.mover->limits.torque = 0.2;
    CHECK(lever_arm_of(layout, 0.23) == 0.0);
    layout.mover->limits.torque = 0.0;
    layout.wheel = test::wheel_of(10.0);
    CHECK(lever_arm_of(layout, 0.23) == 0.0);
    DeviceLayout puck;
    puck.mover = test::puck();
    CHECK(lever_arm_of(puck, 0.23) == 0.0);
}

TEST_CASE("An arm without torque: in the air the wrist turns the wrench about its end") {
    DeviceLayout layout = small_arm();
    Rig rig(layout);
    rig.ticks(2);
    const Pose before = rig.tool();
    const Vec3 end = before * Vec3(0.23, 0.0, 0.0);
    for (int i = 0; i < 300; ++i) {
        rig.hand().orientation = rotation(Vec3(0.0, 1e-3 * i, 0.0));
        rig.tick();
    }
    CHECK(glm::length(rig.tool() * Vec3(0.23, 0.0, 0.0) - end) < 1e-9);
    CHECK(glm::length(rig.tool().position - before.position) ==
          doctest::Approx(2.0 * 0.23 * std::sin(0.1495)).epsilon(1e-3));
}

TEST_CASE(
    "An arm without torque: a swing of its handle tightens the nut, felt as a force against the swing") {
    Rig rig = on_nut(small_arm());
    const servo::NutGeometry& nut = rig.setup.nuts[0];
    const double length = lever_arm_of(rig.layout, rig.setup.wrench.handle_length);
    REQUIRE(length == 0.23);
    DeviceCommands answer;
    double swung = 0.0;  // rad
    const auto handle = [&] { return rig.tool().orientation * Vec3(1.0, 0.0, 0.0); };
    const Vec3 begin = handle();
    // The wrist does not turn. Clockwise as seen from above tightens.
    while (swung < 40.0 && rig.state.output.wrench_torque < 100.0) {
        swung += 5e-4;
        const Vec3 centre = servo::nut_centre(nut, rig.state.output.nut_angle);
        rig.hand().position = device_at(rig, centre + length * (glm::angleAxis(-swung, nut.axis) * begin));
        answer = rig.tick();
        REQUIRE(rig.state.output.joint == 0);
        REQUIRE(rig.state.output.fault == force::Fault::none);
        REQUIRE(glm::length(answer.mover.force) <= 12.0 + 1e-9);
    }
    REQUIRE(rig.state.output.wrench_torque >= 100.0);
    CHECK(glm::dot(handle(), glm::angleAxis(-swung, nut.axis) * begin) > 1.0 - 1e-6);
    answer = rig.ticks(50);
    const Vec3 against = glm::cross(nut.axis, handle());
    const double felt = glm::dot(answer.mover.force, against);
    CHECK(
        felt ==
        doctest::Approx(rig.state.output.wrench_torque * rig.setup.torque_rendering.as_force).epsilon(0.05));
    CHECK(felt > 2.0);
    CHECK(answer.mover.torque == Vec3(0.0));
    // Off the bolt the tool stays where it was; only then does the wrist turn it again.
    const Pose last = rig.tool();
    rig.inputs.controls.grip = servo::Grip::none;
    rig.tick();
    CHECK(glm::length(rig.tool().position - last.position) < 1e-6);
}

TEST_CASE("An arm without torque: the hand holds the end of the tool in use") {
    Rig rig(small_arm());
    servo::ToolSetup longer = rig.setup.tools[0];
    longer.wrench.handle_length = 0.35;
    rig.setup.tools.push_back(longer);
    rig.ticks(100);
    for (const std::uint8_t tool : {std::uint8_t{1}, std::uint8_t{0}}) {
        // The hand lays the tool down and takes the other one.
        rig.inputs.controls.grip = servo::Grip::none;
        rig.ticks(2);
        rig.inputs.controls.tool = tool;
        rig.ticks(2);
        const Pose before = rig.tool();
        rig.inputs.controls.grip = servo::Grip::wrench;
        rig.ticks(2);
        CHECK(rig.setup.tool == tool);
        CHECK(glm::length(rig.tool().position - before.position) < 1e-9);
        const double length = rig.setup.wrench.handle_length;
        CHECK(length == (tool == 1 ? 0.35 : 0.23));
        const Vec3 end = rig.tool() * Vec3(length, 0.0, 0.0);
        for (int i = 0; i < 200; ++i) {
            rig.hand().orientation = rotation(Vec3(0.0, 1e-3, 0.0)) * rig.hand().orientation;
            rig.tick();
        }
        CHECK(glm::length(rig.tool() * Vec3(length, 0.0, 0.0) - end) < 1e-9);
        CHECK(glm::length(rig.tool().position - before.position) > 0.02);
        CHECK(rig.state.output.fault == force::Fault::none);
    }
}

TEST_CASE("An arm without torque: a tilted wrench turns square beside a bolt only while the output is on") {
    for (const bool output : {true, false}) {
        Rig rig = on_nut(small_arm());
        const Vec3 axis = rig.setup.nuts[0].axis;
        const auto raise = [&](double height) {
            for (int i = 0; i < 200; ++i) {
                rig.hand().position += height / 200.0 / rig.layout.workspace.scale * axis;
                rig.tick();
            }
        };
        const auto tilt = [&] {
            return std::acos(std::min(1.0, glm::dot(rig.tool().orientation * Vec3(0, 0, 1), axis)));
        };
        raise(0.2);
        for (int i = 0; i <= 200; ++i) {
            rig.hand().orientation = rotation(Vec3(5e-4 * i, 0.0, 0.0));
            rig.tick();
        }
        REQUIRE(tilt() == doctest::Approx(0.1).epsilon(0.05));
        rig.inputs.controls.dead_man = output;
        raise(-0.17);
        rig.ticks(200);
        CHECK(rig.state.output.joint < 0);
        if (output)
            CHECK(tilt() < 0.01);
        else
            CHECK(tilt() == doctest::Approx(0.1).epsilon(0.05));
    }
}

TEST_CASE("An arm: it moves the tool to the viewer's right wherever the viewer stands, without a jump") {
    Rig rig(test::with_arm());
    rig.ticks(2);
    for (const double yaw : {0.0, 0.7, 2.5, -1.2}) {
        const Quat view = rotation(Vec3(0.0, yaw, 0.0)) * rotation(Vec3(-1.2, 0.0, 0.0));
        rig.inputs.controls.view = view;
        const Pose before = rig.tool();
        rig.tick();
        CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
        rig.hand().position += Vec3(1e-3, 0.0, 0.0);
        rig.tick();
        const Vec3 right = rotation(Vec3(0.0, yaw, 0.0)) * Vec3(1.0, 0.0, 0.0);
        CHECK(glm::length(rig.tool().position - before.position - 1e-3 * right) < 1e-12);
    }
}

}  // namespace station_arm_without_torque_test
