// The tick of a station, from device samples to device commands, without threads and devices.
#include <cstring>

#include "engine/base/random.hpp"
#include "tests/station/test_station.hpp"
#include "tests/support/forbidden.hpp"

namespace station_tick_test {

using namespace bolt;
using namespace bolt::station;
using test::nothing;
using test::on_nut;
using test::Rig;
using test::with_arm;

TEST_CASE("Station: the tool begins at home wherever the hand is, and follows its scaled motion") {
    DeviceLayout layout = with_arm();
    layout.workspace.scale = 3.0;
    layout.workspace.rotation = rotation(Vec3(0, pi / 2, 0));
    Rig rig(layout);
    rig.hand() = {Vec3(0.05, -0.02, 0.01), rotation(Vec3(0.3, 0, 0))};
    rig.tick();
    CHECK(glm::length(rig.tool().position - layout.home.position) < 1e-12);
    CHECK(glm::length(rig.state.input.commanded_tool.position[1] - 0.3F) < 1e-6F);
    for (int i = 0; i < 100; ++i) {
        rig.hand().position.x += 1e-4;
        rig.tick();
    }
    CHECK(glm::length(rig.tool().position - (layout.home.position + Vec3(0, 0, -0.03))) < 1e-9);
}

TEST_CASE("Station: a closed gripper is the dead-man switch, and opens only when the hand opens clearly") {
    DeviceLayout layout = with_arm();
    layout.mover->senses_gripper = true;
    Rig rig(layout);
    rig.inputs.controls.dead_man = false;
    const auto enabled_at = [&](double opening) {
        rig.inputs.mover.sample.gripper = opening;
        rig.tick();
        CHECK(rig.state.gripper.opening == opening);
        CHECK(rig.state.input.dead_man == rig.state.gripper.closed);
        return rig.state.input.dead_man;
    };
    CHECK_FALSE(enabled_at(1.0));
    CHECK_FALSE(enabled_at(gripper_closes_below + 0.01));
    CHECK(enabled_at(gripper_closes_below - 0.01));
    CHECK(enabled_at(gripper_opens_above - 0.01));
    CHECK_FALSE(enabled_at(gripper_opens_above + 0.01));
    CHECK(enabled_at(0.0));
    // A lost arm keeps what the hand holds, without force.
    rig.inputs.mover.usable = rig.mover_speaks = false;
    rig.inputs.mover.sample.gripper = 1.0;
    rig.tick();
    CHECK(rig.state.gripper.closed);
    CHECK_FALSE(rig.state.input.dead_man);
    // The sample of an arm without a gripper does not count.
    layout.mover->senses_gripper = false;
    Rig without(layout);
    without.inputs.controls.dead_man = false;
    without.inputs.mover.sample.gripper = 0.0;
    without.tick();
    CHECK_FALSE(without.state.input.dead_man);
}

TEST_CASE("Station: at a scale of 1 the mover's frame takes its hand to the tool, also after a clutch") {
    Random random(21);
    DeviceLayout layout = test::with_arm();
    layout.mover->limits.torque = 0.0;
    layout.workspace.rotation = rotation({0.0, 2.1, 0.0});
    layout.home.position = {0.1, 0.4, 0.2};  // in the air
    Rig rig(layout);
    rig.setup.wrench.handle_length = 0.2;  // the handle's end follows the hand
    rig.inputs.controls.view = rotation({0.0, -0.7, 0.0});
    rig.ticks(2);
    for (int i = 0; i < 200; ++i) {
        rig.inputs.controls.clutch = i % 20 > 12;
        rig.hand().position += Vec3(random.uniform(-1e-4, 1e-4), random.uniform(-1e-4, 1e-4), 1e-4);
        rig.hand().orientation = rotation({0.0, 1e-3 * i, 0.0});
        ++rig.inputs.mover.number;
        const StationTick tick = step(rig.layout, rig.setup, rig.state, rig.servo, rig.inputs, 1).tick;
        const Vec3 end = tick.commanded_tool * Vec3(0.2, 0.0, 0.0);
        CHECK(glm::length(tick.mover_in_assembly * rig.hand().position - end) < 1e-12);
    }
}

TEST_CASE("Station: after a clutch, a loss or a reconnection the tool stays and follows from there") {
    Rig rig(with_arm());
    rig.ticks(10);
    const Pose before = rig.tool();
    rig.inputs.mover.sample.buttons = 2;
    for (int i = 0; i < 50; ++i) {
        rig.hand().position += Vec3(1e-3, 0, 0);
        rig.tick();
    }
    CHECK(rig.tool().position == before.position);
    rig.inputs.mover.sample.buttons = 0;
    rig.ticks(10);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    // Replugged, with the hand 0.3 m away and rotated.
    rig.inputs.mover.usable = false;
    rig.mover_speaks = false;
    rig.ticks(100);
    rig.inputs.mover.usable = rig.mover_speaks = true;
    ++rig.inputs.mover.connection_number;
    rig.hand().position += Vec3(0, 0.3, 0);
    rig.hand().orientation = rotation(Vec3(0, 0, 1));
    rig.ticks(10);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    CHECK(rig.state.output.fault != force::Fault::jumped);
    rig.hand().position += Vec3(0, 0.001, 0);
    rig.tick();
    CHECK(glm::length(rig.tool().position - before.position) == doctest::Approx(0.001));
}

TEST_CASE("Station: buttons have their configured function, on connected devices only") {
    Rig rig(with_arm());
    rig.layout.mover_buttons = {4, 8, 16, 32};
    rig.inputs.controls.dead_man = false;
    rig.tick();
    CHECK_FALSE(rig.state.input.dead_man);
    rig.inputs.mover.sample.buttons = 4 | 16;
    rig.tick();
    CHECK(rig.state.input.dead_man);
    CHECK(rig.state.input.stop);
    CHECK(rig.state.output.fault == force::Fault::stopped);
    rig.inputs.mover.sample.buttons = 32;
    rig.tick();
    CHECK(rig.state.input.reset);
    CHECK(rig.state.output.fault == force::Fault::none);
    rig.inputs.mover.sample.buttons = 4;
    rig.inputs.mover.usable = false;
    rig.tick();
    CHECK_FALSE(rig.state.input.dead_man);
    rig.inputs.missed = 40;
    rig.tick();
    CHECK(rig.state.input.missed == 15);
}

TEST_CASE("Station: the gloved hand's grip overrides the controls") {
    Rig rig = on_nut(with_arm());
    rig.inputs.hand_grip = servo::Grip::none;
    rig.tick();
    CHECK(rig.state.output.joint < 0);
    rig.inputs.controls.grip = servo::Grip::none;
    rig.inputs.hand_grip = servo::Grip::wrench;
    rig.ticks(5);
    CHECK(rig.state.output.joint == 0);
    rig.inputs.hand_grip.reset();
    rig.tick();
    CHECK(rig.state.output.joint < 0);
}

TEST_CASE("Station: a silent device has zero force 18 ms after its last sample, and ramps up afterwards") {
    for (const bool lost : {false, true}) {
        Rig rig = on_nut(with_arm());
        rig.hand().position.z += 2e-3;  // the nut pulls it back
        REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
        rig.mover_speaks = false;
        rig.inputs.mover.usable = !lost;
        DeviceCommands answer = rig.ticks(7);
        if (!lost) CHECK(glm::length(answer.mover.force) > 1.0);
        answer = rig.ticks(11);
        CHECK(nothing(answer.mover));
        rig.ticks(100);
        CHECK(nothing(rig.tick().mover));
        rig.mover_speaks = rig.inputs.mover.usable = true;
        double before = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().mover.force);
            CHECK(now - before < 0.1);
            before = now;
        }
        CHECK(before > 1.0);
    }
}

TEST_CASE("Station: after a stall of the servo forces ramp up from zero, whatever happened meanwhile") {
    DeviceLayout layout;
    layout.mover = test::puck();
    layout.wheel = test::wheel_of(10.0);
    Rig rig = on_nut(layout);
    for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 150.0; ++i) {
        rig.inputs.wheel.sample.angle += 1e-3;
        rig.tick();
    }
    REQUIRE(glm::length(rig.tick().wheel.torque) > 5.0);
    const auto hangs = [&] {
        rig.inputs.missed = 300;
        CHECK(nothing(rig.tick().wheel));
        rig.inputs.missed = 0;
    };
    SUBCASE("the wheel still sends samples") {
        hangs();
        double before = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().wheel.torque);
            CHECK(now - before < 0.1);
            before = now;
        }
        CHECK(before > 5.0);
    }
    SUBCASE("the dead-man switch was released") {
        rig.inputs.controls.dead_man = false;
        hangs();
        for (int i = 0; i < 1000; ++i) CHECK(nothing(rig.tick().wheel));
    }
    SUBCASE("the wheel falls silent after one more sample") {
        hangs();
        rig.wheel_speaks = false;
        for (int i = 0; i < 1000; ++i) CHECK(nothing(rig.tick().wheel));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
}

TEST_CASE("DeviceLayout: unusable combinations of devices are errors with a message") {
    CHECK_FALSE(check({}));
    DeviceLayout layout;
    layout.mover = test::wheel_of(2.0);
    REQUIRE_FALSE(check(layout));
    CHECK(check(layout).error().message().find("a wheel turns about one axis") != std::string::npos);
    layout.mover = test::arm();
    CHECK(check(layout));
    layout.wheel = test::arm();
    CHECK_FALSE(check(layout));
    layout.wheel = test::wheel_of(2.0);
    CHECK(check(layout));
    layout.mover.reset();
    CHECK(check(layout));
}

TEST_CASE("DeviceLayout: the combined limits are the mover's forces and the wheel's torque") {
    DeviceLayout layout;
    layout.mover = test::puck();
    CHECK(limits_of(layout).force == 0.0);
    CHECK(limits_of(layout).torque == 0.0);
    layout.wheel = test::wheel_of(7.0);
    CHECK(limits_of(layout).torque == 7.0);
    layout.mover = test::arm();
    layout.workspace.scale = 2.0;
    CHECK(limits_of(layout).force == doctest::Approx(0.5 * test::arm().limits.force));
    CHECK(limits_of(layout).torque == 7.0);
    layout.wheel.reset();
    CHECK(limits_of(layout).torque == test::arm().limits.torque);
    CHECK(limits_of(layout).release == doctest::Approx(0.018));
    layout.mover->renders = {true, true, true, false, false, false};
    CHECK(limits_of(layout).torque == 0.0);
}

TEST_CASE("Station: a tick neither allocates nor waits, and the same inputs give the same bits") {
    const auto run = [](test::Forbidden* forbidden) {
        DeviceLayout layout = with_arm();
        layout.wheel = test::wheel_of(5.0);
        Rig rig = on_nut(layout);
        Random random(3);
        std::uint64_t hash = 14695981039346656037ULL;
        const auto all = [&] {
            for (int i = 0; i < 3000; ++i) {
                rig.inputs.wheel.sample.angle += 2e-3 * random.uniform();
                rig.hand().position.x += 1e-5 * random.normal();
                rig.mover_speaks = !random.chance(0.1);
                const DeviceCommands answer = rig.tick();
                unsigned char bytes[sizeof answer];
                std::memcpy(bytes, &answer, sizeof answer);
                for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
            }
        };
        const test::Forbidden seen = test::forbidden_in(all);
        if (forbidden != nullptr) *forbidden = seen;
        return hash;
    };
    test::Forbidden forbidden;
    CHECK(run(&forbidden) == run(nullptr));
    CHECK(forbidden.all() == 0);
}

}  // namespace station_tick_test
