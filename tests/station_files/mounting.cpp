// A station file's mounting, map, buttons and limits, in the ticks of a station.
#include "content/station/station_file.hpp"
#include "engine/base/random.hpp"
#include "haptics/station/station.hpp"
#include "tests/station/test_station.hpp"

namespace station_mounting_test {

using namespace bolt;
using namespace bolt::station;
using test::Rig;

namespace {

content::StationMover arm_of(const std::string& members) {
    const auto station = content::parse_station(
        R"({"format": "boltwright station 1", "arm": {"device": "arm-1")" + members + "}}", "s.json");
    REQUIRE_MESSAGE(station, (station ? "" : station.error().message()));
    return *station->arm;
}

DeviceLayout layout_of(const content::StationMover& arm, const device::Description& device,
                       double handle_length = 0.23) {
    StationOptions options;
    options.workspace = {content::orientation_of(arm.mounting), arm.scale, arm.power_ratio};
    options.mover_limit_bounds = arm.limits;
    options.mover_buttons = arm.buttons.value_or(options.mover_buttons);
    options.handle_length = handle_length;
    options.home = test::with_arm().home;
    Result<DeviceLayout> layout = make_layout(options, device, std::nullopt);
    REQUIRE(layout);
    return *layout;
}

// The motion of the tool, m, for a motion of the handle by `by` m along the axes of the device.
Vec3 motion(const content::StationMover& arm, const Vec3& by) {
    Rig rig(layout_of(arm, test::arm()));
    rig.ticks(3);
    const Vec3 before = rig.tool().position;
    for (int i = 0; i < 10; ++i) {
        rig.hand().position += 0.1 * by;
        rig.tick();
    }
    return rig.tool().position - before;
}

Vec3 any(Random& random) { return {random.normal(), random.normal(), random.normal()}; }

content::StationMover any_arm(Random& random) {
    content::StationMover arm;
    arm.mounting = {random.uniform(-pi, pi), random.uniform(-pi, pi), random.uniform(-pi, pi)};
    arm.scale = random.uniform(0.3, 5.0);
    if (random.chance(0.5)) arm.power_ratio = random.uniform(0.05, 2.0);
    return arm;
}

}  // namespace

TEST_CASE("Station file: the tool moves as the user pushes, however the device is mounted") {
    const double d = 0.01;  // m
    const Vec3 right(d, 0, 0), up(0, d, 0), near(0, 0, d);
    const auto moves = [&](const char* mounting, const Vec3& of_device, const Vec3& of_user) {
        CAPTURE(mounting);
        const auto arm = arm_of(std::string(R"(, "scale": 2, "mounting": )") + mounting);
        CHECK(glm::length(motion(arm, of_device) - 2.0 * of_user) < 1e-9);
    };
    for (const Vec3& axis : {right, up, near}) moves("{}", axis, axis);
    // The user sits behind the device: a push away is one towards the device's own front.
    moves(R"({"yaw_deg": 180})", near, -near);
    moves(R"({"yaw_deg": 180})", right, -right);
    moves(R"({"yaw_deg": 180})", up, up);
    // Its right side points away from the user.
    moves(R"({"yaw_deg": 90})", right, -near);
    moves(R"({"yaw_deg": 90})", near, right);
    // It hangs upside down, its front to the user.
    moves(R"({"roll_deg": 180})", up, -up);
    moves(R"({"roll_deg": 180})", right, -right);
    moves(R"({"roll_deg": 180})", near, near);
    // It lies on its back: the side that was away from the user is up.
    moves(R"({"pitch_deg": 90})", -near, up);
    moves(R"({"pitch_deg": 90})", up, near);
    // Rolled before it is yawed: its up points to its left, which the yaw turns to the user.
    moves(R"({"yaw_deg": 90, "roll_deg": 90})", up, near);
}

TEST_CASE("Station file: the handle feels a force along the user's axes, and power as stated") {
    Random random(11);
    for (int i = 0; i < 50; ++i) {
        const content::StationMover arm = any_arm(random);
        const DeviceLayout layout = layout_of(arm, test::arm());
        CHECK(layout.workspace.scale == *arm.scale);
        CHECK(layout.workspace.power_ratio == arm.power_ratio.value_or(1.0 / *arm.scale));
        const Vec3 on_tool = any(random);
        const force::OutputCommand felt = force::to_device(layout.workspace, {}, {on_tool, Vec3(0.0)});
        const Vec3 of_user = content::orientation_of(arm.mounting) * felt.force;
        CHECK(glm::length(of_user - layout.workspace.power_ratio * *arm.scale * on_tool) < 1e-9);
    }
}

TEST_CASE("Station file: without a scale it is fitted to the reach along the user's axes") {
    device::Description device = test::arm();
    device.half_workspace = Vec3(0.3, 0.2, 0.05);
    for (const auto& [members, reach] : {std::pair{R"()", Vec3(0.3, 0.2, 0.05)},
                                         {R"(, "mounting": {"yaw_deg": 90})", Vec3(0.05, 0.2, 0.3)}}) {
        const DeviceLayout layout = layout_of(arm_of(members), device);
        CHECK(layout.workspace.scale == doctest::Approx(force::fitted_scale(reach, 0.23)));
        CHECK(layout.workspace.power_ratio == 1.0 / layout.workspace.scale);
    }
    CHECK(layout_of(arm_of(""), device).workspace.scale <
          layout_of(arm_of(R"(, "mounting": {"yaw_deg": 90})"), device).workspace.scale);
}

TEST_CASE("Station file: with any mounting and scale, clutching never makes the tool jump") {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        device::Description device = test::arm();
        device.buttons = 8;
        if (random.chance(0.5)) device.limits.torque = 0.0;  // then the handle is the end of the wrench
        content::StationMover arm = any_arm(random);
        arm.buttons = Buttons{1, 32, 0, 0};
        Rig rig(layout_of(arm, device));
        rig.ticks(5);
        const Vec3 along(lever_arm_of(rig.layout, rig.setup.wrench.handle_length), 0.0, 0.0);
        Vec3 last = rig.tool() * along;
        Quat turned = rig.tool().orientation;
        int changes = 0;
        double moved = 0.0;
        for (int i = 0; i < 10'000; ++i) {
            if (random.chance(0.01)) {
                rig.inputs.mover.sample.buttons ^= 32U;
                ++changes;
            }
            const Vec3 shift = 1e-4 * any(random), turn = 1e-3 * any(random);
            rig.hand().position += shift;
            rig.hand().orientation = glm::normalize(rotation(turn) * rig.hand().orientation);
            rig.tick();
            const double way = glm::length(rig.tool() * along - last);
            const double angle = glm::length(turn_between(turned, rig.tool().orientation));
            const bool clutch = (rig.inputs.mover.sample.buttons & 32U) != 0;
            REQUIRE(way <= (clutch ? 0.0 : *arm.scale * glm::length(shift)) + 1e-9);
            // Beside a bolt the wrench may also turn to it, by 1 rad/s.
            REQUIRE(angle <= (clutch ? 0.0 : glm::length(turn) + 1e-3) + 1e-9);
            moved += way;
            last = rig.tool() * along;
            turned = rig.tool().orientation;
        }
        CHECK(changes > 50);
        CHECK(moved > 0.1);
    }
}

TEST_CASE("Station file: limits are only ever lowered, and no command of a tick exceeds them") {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        CAPTURE(seed);
        Random random(seed);
        device::Description device = test::arm();
        device.limits.force = random.uniform(1.0, 30.0);
        device.limits.torque = random.uniform(0.1, 3.0);
        content::StationMover arm = any_arm(random);
        if (random.chance(0.8)) arm.limits.force = random.uniform(0.0, 40.0);
        if (random.chance(0.8)) arm.limits.torque = random.uniform(0.05, 4.0);
        if (random.chance(0.8)) arm.limits.stiffness = random.uniform(50.0, 4000.0);
        const DeviceLayout layout = layout_of(arm, device);
        const double force = std::min(device.limits.force, arm.limits.force.value_or(1e9));
        const double torque = std::min(device.limits.torque, arm.limits.torque.value_or(1e9));
        CHECK(layout.mover->limits.force == force);
        CHECK(layout.mover->limits.torque == torque);
        CHECK(layout.mover->limits.stiffness <= device.limits.stiffness);

        Rig rig = test::on_nut(layout);
        CHECK(rig.setup.hold_stiffness <= rig.setup.limits.stiffness);
        double greatest = 0.0;
        for (int i = 0; i < 400; ++i) {
            rig.hand().position += 2e-4 * any(random);
            rig.hand().orientation = glm::normalize(rotation(2e-3 * any(random)) * rig.hand().orientation);
            const DeviceCommands answer = rig.tick();
            REQUIRE(glm::length(answer.mover.force) <= force * (1.0 + 1e-9) + 1e-12);
            REQUIRE(glm::length(answer.mover.torque) <= torque * (1.0 + 1e-9) + 1e-12);
            greatest = std::max(greatest, glm::length(answer.mover.force));
        }
        CHECK((greatest > 0.0) == (force > 0.0));
    }
}

TEST_CASE("Station file: its buttons have their functions in the ticks") {
    const auto arm = arm_of(R"(, "buttons": {"dead_man": [2, 5], "clutch": 1, "stop": 3, "reset": 4})");
    device::Description device = test::arm();
    device.buttons = 5;
    Rig rig(layout_of(arm, device));
    rig.inputs.controls.dead_man = false;
    const auto with = [&](std::uint32_t pressed) {
        rig.inputs.mover.sample.buttons = pressed;
        rig.tick();
        return rig.state.input;
    };
    CHECK(!with(0).dead_man);
    CHECK(!with(1).dead_man);
    CHECK(with(2).dead_man);
    CHECK(with(16).dead_man);
    CHECK(with(4).stop);
    CHECK(with(8).reset);
    const Vec3 before = rig.tool().position;
    rig.hand().position.x += 0.01;
    with(1);
    CHECK(rig.tool().position == before);
}

}  // namespace station_mounting_test
