#include "haptics/servo/tick.hpp"

#include <doctest/doctest.h>

#include <unistd.h>

#include <chrono>
#include <mutex>

#include "tests/servo/support.hpp"
#include "tests/support/forbidden.hpp"
#include "tests/support/skip.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

// Reaches above the nut, lowers the wrench onto it, pulls by 40 degrees, releases and lifts.
TickInput scripted(const Setup& setup, const State& state, int i) {
    const NutGeometry& nut = setup.nuts[0];
    const double fits = setup.wrench.head_angle;
    const double height = i < 1000 ? 0.05 * (1.0 - i / 1000.0) : i < 4000 ? 0.0 : 0.05 * (i - 4000) / 1000.0;
    const double pull = i < 1500 ? 0.0 : std::min(i - 1500, 2000) / 2000.0 * to_radians(40.0);
    const Vec3 at = nut_centre(nut, state.joints[0].nut.angle) + nut.axis * height;
    TickInput input = test::holding(Grip::wrench, test::tool_at(nut, at, fits + pull));
    input.guided_joint = 0;
    return input;
}

}  // namespace

TEST_CASE("Servo: a tick does not allocate, lock, do I/O or read a clock") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const test::Forbidden in_ticks = test::forbidden_in([&] {
        for (int i = 0; i < 5000; ++i) tick(setup, state, scripted(setup, state, i));
    });
    CHECK(in_ticks.allocations == 0);
    CHECK(in_ticks.locks == 0);
    CHECK(in_ticks.io == 0);
    CHECK(in_ticks.clocks == 0);
}

TEST_CASE("Servo: the checker detects each forbidden call") {
    CHECK(test::forbidden_in([] { std::vector<int> seen(100); }).allocations >= 2);
    if (test::sees_the_c_library) {
        void* volatile memory = nullptr;
        CHECK(test::forbidden_in([&] { memory = std::malloc(10); }).allocations == 1);
        std::free(memory);
        std::mutex mutex;
        CHECK(test::forbidden_in([&] { const std::lock_guard lock(mutex); }).locks == 1);
        CHECK(test::forbidden_in([] { CHECK(write(-1, nullptr, 0) == -1); }).io >= 1);
        CHECK(test::forbidden_in([] { (void)std::fflush(stdout); }).io == 1);
        CHECK(test::forbidden_in([] { (void)std::chrono::steady_clock::now(); }).clocks == 1);
        CHECK(test::forbidden_in([] { usleep(0); }).clocks >= 1);
    } else {
        test::skip_part("sanitizers replace the C library's functions; only operator new is counted");
    }
    CHECK(test::forbidden_in([] {}).all() == 0);
}

TEST_CASE("Servo: a tick makes no system call") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    auto ticks = [&] {
        for (int i = 0; i < 5000; ++i) tick(setup, state, scripted(setup, state, i));
    };
    if (test::sees_the_c_library)
        CHECK(test::makes_no_system_call(ticks));
    else
        test::skip_part("sanitizers make system calls of their own");
    auto asks = [] { (void)getppid(); };
    CHECK_FALSE(test::makes_no_system_call(asks));
}

TEST_CASE("Servo: the same inputs give the same bits") {
    const auto run = [] {
        const Setup setup = test::two_joints();
        State state = initial_state(setup);
        std::uint64_t hash = 14695981039346656037ULL;
        for (int i = 0; i < 5000; ++i) {
            const Output output = tick(setup, state, scripted(setup, state, i));
            const double values[] = {output.force.x,       output.force.y,   output.torque.y,
                                     output.wrench_torque, output.nut_angle, output.clamp};
            const auto* bytes = reinterpret_cast<const unsigned char*>(values);
            for (std::size_t k = 0; k < sizeof values; ++k) hash = (hash ^ bytes[k]) * 1099511628211ULL;
        }
        return hash;
    };
    CHECK(run() == run());
}

TEST_CASE("Servo: reach, engage, turn and release keep force and torque within the slew rates") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    Output last;
    bool engaged = false, turned = false;
    for (int i = 0; i < 5000; ++i) {
        const Output output = tick(setup, state, scripted(setup, state, i));
        REQUIRE(glm::length(output.force - last.force) <= setup.limits.force_slew_rate * setup.dt * 1.0001);
        REQUIRE(glm::length(output.torque - last.torque) <=
                setup.limits.torque_slew_rate * setup.dt * 1.0001);
        // Engaging adds no torque: the nut's torque starts at zero.
        if (output.joint == 0 && last.joint == -1) CHECK(output.wrench_torque == 0.0);
        engaged = engaged || output.joint == 0;
        turned = turned || output.nut_angle > to_radians(30.0);
        last = output;
    }
    CHECK(engaged);
    CHECK(turned);
}

TEST_CASE(
    "Servo: the nut's torque acts about the bolt's axis against the pull, scaled to the device's range") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    Output output;
    double angle = setup.wrench.head_angle;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        output = tick(setup, state, test::holding(Grip::wrench, test::tool_at(nut, at, angle)));
        if (output.wrench_torque < 150.0) angle += to_radians(0.05);
    }
    REQUIRE(output.wrench_torque > 140.0);
    CHECK(output.torque.y ==
          doctest::Approx(output.wrench_torque * setup.torque_rendering.scale).epsilon(0.02));
    CHECK(output.torque.y < setup.limits.torque);
    CHECK(setup.torque_rendering.scale * 210.0 == doctest::Approx(0.8 * setup.limits.torque));
}

TEST_CASE("Servo: a device without torque renders it as a force across the handle") {
    force::OutputLimits limits;
    limits.torque = 0.0;
    const Setup setup = test::two_joints(limits);
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    Output output;
    double angle = setup.wrench.head_angle;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        output = tick(setup, state, test::holding(Grip::wrench, test::tool_at(nut, at, angle)));
        if (output.wrench_torque < 150.0) angle += to_radians(0.05);
    }
    REQUIRE(output.wrench_torque > 140.0);
    const ToolPose tool = tool_pose(test::tool_at(nut, Vec3(0.0), angle));
    const Vec3 pull = glm::cross(-nut.axis, tool.handle);  // direction of the grip's motion when tightening
    CHECK(glm::dot(output.force, pull) ==
          doctest::Approx(-output.wrench_torque * setup.torque_rendering.as_force).epsilon(0.05));
    CHECK(glm::length(output.torque) == 0.0);
}

TEST_CASE("Servo: a wheel renders the nut's whole torque, on and off centre") {
    force::OutputLimits limits;
    limits.force = 0.0;
    const Setup setup = test::two_joints(limits);
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    Output output;
    double angle = setup.wrench.head_angle;
    for (int i = 0; i < 20'000; ++i) {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle) + 0.5e-3 * nut.e1;
        output = tick(setup, state, test::holding(Grip::wrench, test::tool_at(nut, at, angle)));
        if (output.wrench_torque < 150.0) angle += to_radians(0.05);
    }
    REQUIRE(output.wrench_torque > 140.0);
    CHECK(output.torque.y ==
          doctest::Approx(output.wrench_torque * setup.torque_rendering.scale).epsilon(0.02));
    CHECK(glm::length(output.force) == 0.0);
}

TEST_CASE("Fingers: they run the nut down and slip at its seat") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    Output output;
    for (int i = 0; i < 6000; ++i) {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        output = tick(setup, state, test::holding(Grip::fingers, test::tool_at(nut, at, 3e-3 * i)));
        REQUIRE(output.wrench_torque <= setup.finger_torque(nut) * 1.0001);
    }
    CHECK(output.stage != joint::Stage::navigation);
    CHECK(output.nut_angle == doctest::Approx(2 * pi).epsilon(0.1));  // a gap of 2 mm and a pitch of 2 mm
}

TEST_CASE("Servo: the hand's angle is unwrapped across half turns") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    for (int i = 0; i < 2000; ++i) {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        tick(setup, state, test::holding(Grip::fingers, test::tool_at(nut, at, 2.5e-3 * i)));
    }
    CHECK(state.joints[0].nut.angle == doctest::Approx(5.0).epsilon(0.02));
}

TEST_CASE("Servo: without the dead-man switch nothing is held or rendered") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    for (int i = 0; i < 3000; ++i) {
        TickInput input = scripted(setup, state, 1500 + i % 1000);
        input.dead_man = false;
        const Output output = tick(setup, state, input);
        REQUIRE(output.joint == -1);
        REQUIRE(glm::length(output.force) == 0.0);
        REQUIRE(glm::length(output.torque) == 0.0);
    }
    CHECK(state.joints[0].nut.angle == 0.0);
}
