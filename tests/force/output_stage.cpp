// The output stage as a whole: after any upstream fault it releases the hand within 20 ms, without a jerk.
#include "haptics/force/output_stage.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>

#include "engine/base/random.hpp"
#include "tests/support/forbidden.hpp"

namespace force_output_stage_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;
const ForceRequest hard{{Vec3(100, 0, 0), Vec3(0, 100, 0)}};

DeviceInput held() {
    DeviceInput input;
    input.dead_man = true;
    return input;
}

OutputStage at_full(const OutputLimits& limits) {
    OutputStage stage;
    for (int i = 0; i < 2000; ++i)
        render(limits, stage, held(), {{Vec3(0.8 * limits.force, 0, 0), Vec3(0.0)}}, dt);
    REQUIRE(stage.limiter.force.x == doctest::Approx(0.8 * limits.force));
    return stage;
}

bool nothing(const OutputCommand& out) { return out.force == Vec3(0.0) && out.torque == Vec3(0.0); }

}  // namespace

TEST_CASE("Output stage: zero within 20 ms of silence, NaN, a jump, a stop or a released dead-man switch") {
    const OutputLimits limits;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int cause = 0; cause < 6; ++cause) {
        CAPTURE(cause);
        OutputStage stage = at_full(limits);
        DeviceInput input = held();
        ForceRequest request = hard;
        if (cause == 0) input.fresh = false;
        if (cause == 1) input.pose.position.x = nan;
        if (cause == 2) input.pose.position.x = 0.5;
        if (cause == 3) input.stop = true;
        if (cause == 4) input.dead_man = false;
        if (cause == 5) request.command.torque.z = nan;
        OutputCommand out;
        for (int i = 0; i < 20; ++i) out = render(limits, stage, input, request, dt);
        CHECK(nothing(out));
        if (cause != 2)
            for (int i = 0; i < 2000; ++i) REQUIRE(nothing(render(limits, stage, input, request, dt)));
    }
}

TEST_CASE("Output stage: a runaway at 5 m/s is released within 20 ms") {
    const OutputLimits limits;
    OutputStage stage = at_full(limits);
    DeviceInput input = held();
    OutputCommand out;
    for (int i = 0; i < 20; ++i) {
        input.pose.position.x += 5.0 * dt;
        out = render(limits, stage, input, hard, dt);
    }
    CHECK(nothing(out));
    CHECK(stage.watchdog.fault == Fault::too_fast);
}

TEST_CASE("Output stage: after a fault the force ramps up") {
    const OutputLimits limits;
    OutputStage stage = at_full(limits);
    DeviceInput input = held();
    input.fresh = false;
    for (int i = 0; i < 50; ++i) render(limits, stage, input, hard, dt);
    input.fresh = true;
    const ForceRequest request{{Vec3(10, 0, 0), Vec3(0.0)}};
    for (int i = 0; i < 99; ++i) CHECK(nothing(render(limits, stage, input, request, dt)));
    for (int i = 0; i < 250; ++i) render(limits, stage, input, request, dt);
    CHECK(stage.limiter.force.x == doctest::Approx(5.0).epsilon(0.02));
}

TEST_CASE("Output stage: for any input the output is finite, within the limits and the slew rates") {
    const OutputLimits limits;
    Random random(12);
    OutputStage stage;
    Vec3 last(0.0);
    DeviceInput input = held();
    const auto wild = [&] { return random.normal() * std::pow(10.0, random.uniform(-3.0, 200.0)); };
    // Silence leaves the shortest time for the release.
    const double fastest =
        std::max(limits.force_slew_rate, limits.force / (limits.release - limits.max_silence - dt)) * dt;
    std::uint64_t rendered = 0;
    int running = 0;
    for (int i = 0; i < 200'000; ++i) {
        ForceRequest request;
        for (int k = 0; k < 3; ++k) {
            request.command.force[k] = wild();
            request.command.torque[k] = wild();
        }
        request.stored_energy = std::abs(wild());
        request.injected_energy = wild();
        if (random.chance(0.5)) request = {{Vec3(5.0 * random.normal(), 0, 3), Vec3(0, 0.3, 0)}};
        if (random.chance(0.0005)) request.command.force.y = std::numeric_limits<double>::infinity();
        if (random.chance(0.0005)) request.stored_energy = std::numeric_limits<double>::quiet_NaN();
        input.pose.position += 1e-3 * Vec3(random.normal(), random.normal(), random.normal());
        input.pose.orientation =
            glm::normalize(rotation(0.01 * Vec3(random.normal(), 0, 1)) * input.pose.orientation);
        if (random.chance(0.0002)) input.pose.position.z += 0.05;
        if (random.chance(0.0002)) running = 30;
        if (running-- > 0) input.pose.position.y += 5e-3;
        if (glm::length(input.pose.position) > 100.0) input.pose.position = Vec3(0.0);
        DeviceInput now = input;
        if (random.chance(0.0003)) now.pose.position.x = wild();
        now.fresh = random.chance(0.9);
        now.dead_man = random.chance(0.9995);
        now.stop = random.chance(0.0001);
        now.reset = random.chance(0.5);
        const OutputCommand out = render(limits, stage, now, request, dt);
        REQUIRE(glm::length(out.force) <= limits.force * (1 + 1e-12));
        REQUIRE(glm::length(out.torque) <= limits.torque * (1 + 1e-12));
        REQUIRE(glm::length(out.force - last) <= fastest * (1 + 1e-9));
        REQUIRE(std::isfinite(stage.passivity.balance));
        rendered += nothing(out) ? 0U : 1U;
        last = out.force;
    }
    CHECK(rendered > 50'000);
    for (std::size_t i = 1; i < fault_kinds; ++i)
        if (i != static_cast<std::size_t>(Fault::silent)) CHECK(stage.watchdog.counts[i] > 0);
}

TEST_CASE("Output stage: a request that is not finite counts as a fault in the watchdog and in the limiter") {
    const OutputLimits limits;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (int part = 0; part < 3; ++part) {
        CAPTURE(part);
        OutputStage stage = at_full(limits);
        ForceRequest request = hard;
        if (part == 0) request.command.force.x = nan;
        if (part == 1) request.stored_energy = nan;
        if (part == 2) request.injected_energy = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 3; ++i) render(limits, stage, held(), request, dt);
        CHECK(stage.watchdog.fault == Fault::bad_request);
        CHECK(stage.watchdog.counts[static_cast<std::size_t>(Fault::bad_request)] == 1);
        CHECK(stage.limiter.invalid_requests == 3);
    }
}

TEST_CASE("Output stage: during missed deadlines the last command counts for as long as it was applied") {
    OutputLimits limits;
    limits.delay = 0;
    limits.ramp_up = dt;
    limits.damping = limits.angular_damping = 0.0;
    limits.force_slew_rate = 1e6;
    OutputStage stage;
    DeviceInput input = held();
    const auto push = [&](double newton) {
        render(limits, stage, input, {{Vec3(newton, 0, 0), Vec3(0.0)}}, dt);
    };
    push(1.0);
    input.fresh = false;
    push(3.0);  // 1 N was applied for one tick
    input.fresh = true;
    input.missed = 2;
    input.pose.position.x = 1e-3;
    const double before = stage.passivity.balance;
    push(0.0);  // 3 N was applied for three ticks
    CHECK(before - stage.passivity.balance == doctest::Approx((1.0 + 3.0 * 3.0) / 4.0 * 1e-3));
}

TEST_CASE(
    "Output stage: releasing the dead-man switch clears the energy balance, so nothing is damped "
    "afterwards") {
    const OutputLimits limits;
    OutputStage stage = at_full(limits);
    stage.passivity.balance = -1.0;
    DeviceInput input = held();
    input.dead_man = false;
    for (int i = 0; i < 30; ++i) render(limits, stage, input, {}, dt);
    input.dead_man = true;
    for (int i = 0; i < 600; ++i) {
        input.pose.position.x += 1e-4;
        const OutputCommand out = render(limits, stage, input, {}, dt);
        REQUIRE(nothing(out));
    }
}

TEST_CASE("Output stage: no allocation, lock or clock; the same inputs give the same bits") {
    const auto run = [] {
        OutputStage stage;
        DeviceInput input = held();
        Random random(5);
        OutputCommand out;
        std::uint64_t hash = 14695981039346656037ULL;
        for (int i = 0; i < 3000; ++i) {
            input.pose.position += 1e-4 * Vec3(random.normal(), random.normal(), random.normal());
            out = render({}, stage, input, {{-800.0 * input.pose.position, Vec3(0, 0.1, 0)}, 1e-3}, dt);
            unsigned char bytes[sizeof out];
            std::memcpy(bytes, &out, sizeof out);
            for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
        }
        return hash;
    };
    std::uint64_t first = 0;
    CHECK(test::forbidden_in([&] { first = run(); }).all() == 0);
    CHECK(run() == first);
}

}  // namespace force_output_stage_test
