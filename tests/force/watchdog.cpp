// The inputs that the watchdog rejects, the recovery times and the reported faults.
#include "haptics/force/output_stage.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace force_watchdog_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;

struct Device {
    OutputLimits limits;
    WatchdogState state;
    DeviceInput input;
    Device() { input.dead_man = true; }

    bool step() { return update_watchdog(limits, state, input, true, dt); }
    // Moves along x at `speed` (m/s) for `ticks`; returns the last result of step().
    bool move(double speed, int ticks) {
        bool may = false;
        for (int i = 0; i < ticks; ++i) {
            input.pose.position.x += speed * dt;
            may = step();
        }
        return may;
    }
    int ticks_until(bool wanted, double speed = 0.0) {
        for (int n = 1; n <= 1000; ++n)
            if (move(speed, 1) == wanted) return n;
        return -1;
    }
    [[nodiscard]] std::uint64_t count(Fault fault) const {
        return state.counts[static_cast<std::size_t>(fault)];
    }
};

}  // namespace

TEST_CASE("Watchdog: hand motion is accepted from the first sample, up to 2 m/s") {
    Device device;
    device.input.pose.position = Vec3(0.3, -0.2, 5.0);
    CHECK(device.step());
    CHECK(device.move(2.0, 200));
    CHECK(device.move(-2.0, 400));
    for (const std::uint64_t n : device.state.counts) CHECK(n == 0);
}

TEST_CASE("Watchdog: the motion has shift, turn and velocity") {
    Device device;
    device.step();
    CHECK_FALSE(device.state.motion.fresh);  // a motion needs two samples
    device.move(0.5, 20);
    CHECK(device.state.motion.fresh);
    CHECK(device.state.motion.shift.x == doctest::Approx(0.5e-3));
    CHECK(device.state.motion.velocity.x == doctest::Approx(0.5).epsilon(1e-4));
    for (int i = 0; i < 20; ++i) {
        device.input.pose.orientation =
            glm::normalize(rotation(Vec3(0, 0, 2e-3)) * device.input.pose.orientation);
        device.step();
    }
    CHECK(device.state.motion.rotation.z == doctest::Approx(2e-3));
    CHECK(device.state.motion.angular_velocity.z == doctest::Approx(2.0).epsilon(1e-4));
    // After a silent tick and a missed one the turn covers three ticks; the velocity is unchanged.
    device.input.fresh = false;
    device.step();
    CHECK_FALSE(device.state.motion.fresh);
    device.input.missed = 1;
    device.input.fresh = true;
    device.input.pose.orientation =
        glm::normalize(rotation(Vec3(0, 0, 6e-3)) * device.input.pose.orientation);
    device.step();
    CHECK(device.state.motion.rotation.z == doctest::Approx(6e-3));
    CHECK(device.state.motion.angular_velocity.z == doctest::Approx(2.0).epsilon(1e-4));
}

TEST_CASE("Watchdog: eight silent milliseconds are accepted, nine are a fault; missed deadlines count") {
    Device device;
    device.move(0.1, 10);
    device.input.fresh = false;
    for (int i = 0; i < 8; ++i) CHECK(device.step());
    CHECK_FALSE(device.step());
    CHECK(device.state.fault == Fault::silent);
    CHECK(device.count(Fault::silent) == 1);
    device.input.fresh = true;
    CHECK(device.ticks_until(true) == 100);
    CHECK(device.count(Fault::silent) == 1);

    device.input.fresh = false;
    device.input.missed = 8;  // the loop paused for nine ticks
    CHECK_FALSE(device.step());
    CHECK(device.state.fault == Fault::silent);
}

TEST_CASE("Watchdog: an invalid pose is a fault, counted once, with recovery") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::function<void(DeviceInput&)> broken[] = {
        [&](DeviceInput& in) { in.pose.position.y = nan; },
        [&](DeviceInput& in) { in.pose.position.z = std::numeric_limits<double>::infinity(); },
        [&](DeviceInput& in) { in.pose.position.x = 1e300; },
        [&](DeviceInput& in) { in.pose.orientation.w = nan; },
        [&](DeviceInput& in) { in.pose.orientation = Quat(0.0, 0.0, 0.0, 0.0); },
        [&](DeviceInput& in) { in.pose.orientation = Quat(2.0, 0.0, 0.0, 0.0); },
        [&](DeviceInput& in) { in.valid = false; },
    };
    for (const auto& spoil : broken) {
        Device device;
        device.move(0.1, 10);
        const DeviceInput good = device.input;
        spoil(device.input);
        for (int i = 0; i < 5; ++i) CHECK_FALSE(device.step());
        CHECK(device.state.fault == Fault::no_pose);
        CHECK(device.count(Fault::no_pose) == 1);
        device.input = good;
        device.input.pose.position.x += 0.2;  // the first valid pose is a start, not a jump
        CHECK(device.ticks_until(true) == 100);
        CHECK(device.count(Fault::jumped) == 0);
        CHECK(glm::length(device.state.motion.velocity) == 0.0);
    }
}

TEST_CASE("Watchdog: a jump is a fault without velocity; the new pose is accepted after the recovery time") {
    Device device;
    device.move(0.1, 10);
    device.input.pose.position.y += 0.031;
    CHECK_FALSE(device.step());
    CHECK(device.state.fault == Fault::jumped);
    CHECK(glm::length(device.state.motion.velocity) == 0.0);
    CHECK(device.ticks_until(true) == 100);

    device.input.pose.orientation = rotation(Vec3(0, 0.51, 0));
    CHECK_FALSE(device.step());
    CHECK(device.state.fault == Fault::jumped);
    CHECK(device.count(Fault::jumped) == 2);
    // A pose that alternates between two positions is never accepted.
    for (int i = 0; i < 500; ++i) {
        device.input.pose.position.x = i % 2 == 0 ? 0.0 : 0.1;
        CHECK_FALSE(device.step());
    }
}

TEST_CASE("Watchdog: the jump limit scales with the time between samples") {
    Device device;
    device.limits.jump = 5e-3;
    for (int i = 0; i < 400; ++i) {
        device.input.fresh = i % 4 == 0;
        if (device.input.fresh) device.input.pose.position.x += 8e-3;
        CHECK(device.step());
    }
    CHECK(device.state.motion.velocity.x == doctest::Approx(2.0).epsilon(1e-3));
    device.input.fresh = true;
    device.step();
    device.input.pose.position.x += 8e-3;
    CHECK_FALSE(device.step());
}

TEST_CASE("Watchdog: excess speed is a fault within 20 ms, until it falls to half the limit") {
    Device device;
    device.move(0.1, 10);
    const int held_off = device.ticks_until(false, 3.5);
    CHECK(held_off > 1);
    CHECK(held_off <= 10);  // detection within 10 ms leaves 10 of the 20 ms for a runaway at twice the speed
    CHECK(device.state.fault == Fault::too_fast);
    CHECK_FALSE(device.move(2.0, 300));
    CHECK(device.move(1.0, 300));
    CHECK(device.count(Fault::too_fast) == 1);

    for (int i = 0; i < 30; ++i) {
        device.input.pose.orientation =
            glm::normalize(rotation(Vec3(0.06, 0, 0)) * device.input.pose.orientation);
        device.step();
    }
    CHECK(device.state.fault == Fault::too_fast);
}

TEST_CASE("Watchdog: a request that is not finite is a fault") {
    Device device;
    device.move(0.1, 10);
    CHECK_FALSE(update_watchdog(device.limits, device.state, device.input, false, dt));
    CHECK(device.state.fault == Fault::bad_request);
    CHECK(device.ticks_until(true) == 100);
}

TEST_CASE(
    "Watchdog: the emergency stop overrides all faults and lasts until a reset without the dead-man switch") {
    Device device;
    device.move(0.1, 10);
    device.input.stop = true;
    CHECK_FALSE(device.step());
    device.input.stop = false;
    CHECK_FALSE(device.move(0.0, 5000));
    CHECK(device.state.fault == Fault::stopped);
    device.input.reset = true;  // a reset with the dead-man switch held would start by itself
    CHECK_FALSE(device.move(0.0, 10));
    device.input.dead_man = false;
    device.input.stop = true;  // the stop is still pressed
    CHECK_FALSE(device.move(0.0, 10));
    device.input.stop = false;
    CHECK(device.move(0.0, 1));
    CHECK(device.count(Fault::stopped) == 1);

    device.input = {};
    device.input.stop = true;
    device.input.pose.position.x = std::numeric_limits<double>::quiet_NaN();
    device.step();
    CHECK(device.state.fault == Fault::stopped);
    device.input.stop = false;  // a device fault does not clear the stop
    device.step();
    CHECK(device.state.fault == Fault::stopped);
}

TEST_CASE("Watchdog: every fault has a message") {
    for (std::size_t i = 0; i < fault_kinds; ++i)
        for (std::size_t j = 0; j < i; ++j)
            CHECK(std::string(message_for(static_cast<Fault>(i))) != message_for(static_cast<Fault>(j)));
}

}  // namespace force_watchdog_test
