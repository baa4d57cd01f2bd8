// limit_output() for torque, and its state across release and faults.
#include "haptics/force/output_stage.hpp"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>

#include "engine/base/random.hpp"

namespace force_limiter_test {

using namespace bolt;
using namespace bolt::force;

namespace {

constexpr double dt = 1e-3;
const OutputCommand full{Vec3(100, 0, 0), Vec3(0, 100, 0)};

LimiterState at_full(const OutputLimits& limits) {
    LimiterState state;
    for (int i = 0; i < 2000; ++i) limit_output(limits, state, full, true, dt);
    return state;
}

}  // namespace

TEST_CASE("Limiter: a step of torque is followed at the slew rate, 0.2 N m per millisecond") {
    OutputLimits limits;
    limits.ramp_up = dt;
    LimiterState state;
    for (int i = 1; i <= 10; ++i)
        CHECK(limit_output(limits, state, full, true, dt).torque.y == doctest::Approx(0.2 * i));
    CHECK(limit_output(limits, state, full, true, dt).torque.y == doctest::Approx(2.0));
    const OutputCommand back{Vec3(0.0), Vec3(0, -1, 0)};
    for (int i = 1; i <= 15; ++i)
        CHECK(limit_output(limits, state, back, true, dt).torque.y == doctest::Approx(2.0 - 0.2 * i));
}

TEST_CASE("Limiter: torque and force have the same ramp") {
    const OutputLimits limits;
    LimiterState state;
    for (int i = 1; i <= 500; ++i) {
        const OutputCommand out = limit_output(limits, state, {Vec3(10, 0, 0), Vec3(0, 1, 0)}, true, dt);
        REQUIRE(out.torque.y == doctest::Approx(i / 500.0));
        REQUIRE(out.force.x == doctest::Approx(10.0 * i / 500.0));
    }
}

TEST_CASE("Limiter: a release from full output falls by a twentieth per millisecond to exactly zero") {
    const OutputLimits limits;
    LimiterState state = at_full(limits);
    REQUIRE(state.torque.y == doctest::Approx(limits.torque));
    for (int i = 1; i <= 20; ++i) {
        const OutputCommand out = limit_output(limits, state, full, false, dt);
        CHECK(out.torque.y == doctest::Approx(limits.torque * (20 - i) / 20.0).epsilon(1e-6));
        CHECK(out.force.x == doctest::Approx(limits.force * (20 - i) / 20.0).epsilon(1e-6));
    }
    CHECK(state.torque == Vec3(0.0));
    CHECK(state.force == Vec3(0.0));
}

TEST_CASE("Limiter: enabled again after a release or a fault the output ramps up from zero") {
    const OutputLimits limits;
    const OutputCommand sound{Vec3(10, 0, 0), Vec3(0, 1, 0)};
    OutputCommand broken = sound;
    broken.torque.z = std::numeric_limits<double>::quiet_NaN();
    for (const bool let_go : {true, false}) {
        LimiterState state = at_full(limits);
        for (int i = 0; i < 20; ++i) limit_output(limits, state, let_go ? sound : broken, !let_go, dt);
        REQUIRE(state.force == Vec3(0.0));
        CHECK(state.ramp == 0.0);
        for (int i = 0; i < 50; ++i) limit_output(limits, state, sound, true, dt);
        CHECK(state.force.x == doctest::Approx(1.0));
        CHECK(state.torque.y == doctest::Approx(0.1));
    }
}

TEST_CASE("Limiter: a state that is not finite is cleared") {
    const OutputLimits limits;
    const OutputCommand wanted{Vec3(60, 50, 40), Vec3(3, 4, 5)};
    const double bad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    for (const double value : bad) {
        for (int k = 0; k < 6; ++k) {
            for (const bool enabled : {true, false}) {
                CAPTURE(k);
                CAPTURE(enabled);
                LimiterState state;
                for (int i = 0; i < 2000; ++i) limit_output(limits, state, wanted, true, dt);
                (k < 3 ? state.force : state.torque)[k % 3] = value;
                OutputCommand out = limit_output(limits, state, wanted, enabled, dt);
                for (int i = 0; i < 3; ++i) {
                    CHECK(std::isfinite(out.force[i]));
                    CHECK(std::isfinite(out.torque[i]));
                }
                CHECK(out.force == Vec3(0.0));
                CHECK(out.torque == Vec3(0.0));
                CHECK(state.ramp == 0.0);
                CHECK(state.invalid_requests == 1);
                // The output recovers.
                for (int i = 0; i < 1000; ++i) out = limit_output(limits, state, wanted, true, dt);
                CHECK(glm::length(out.force) == doctest::Approx(limits.force));
                CHECK(glm::length(out.torque) == doctest::Approx(limits.torque));
            }
        }
    }
}

TEST_CASE("Limiter: for any request the output is within the limits and the slew rate") {
    const OutputLimits limits;
    Random random(4);
    LimiterState state;
    Vec3 last(0.0);
    for (int i = 0; i < 100'000; ++i) {
        OutputCommand wanted;
        for (int k = 0; k < 3; ++k) {
            wanted.force[k] = random.normal() * std::pow(10.0, random.uniform(-3.0, 200.0));
            wanted.torque[k] = random.normal() * std::pow(10.0, random.uniform(-3.0, 200.0));
        }
        if (random.chance(0.01)) wanted.force.x = std::numeric_limits<double>::quiet_NaN();
        if (random.chance(0.01)) wanted.torque.y = std::numeric_limits<double>::infinity();
        const bool enabled = random.chance(0.95);
        const OutputCommand out = limit_output(limits, state, wanted, enabled, dt);
        REQUIRE(glm::length(out.force) <= limits.force * (1 + 1e-12));
        REQUIRE(glm::length(out.torque) <= limits.torque * (1 + 1e-12));
        // While rendering, the slew rate bounds the change; a release may be faster, never slower.
        const double most = std::max(limits.force_slew_rate, limits.force / limits.release) * dt;
        REQUIRE(glm::length(out.force - last) <= most * (1 + 1e-9));
        last = out.force;
    }
    CHECK(state.invalid_requests > 0);
}

TEST_CASE("Limiter: without the dead-man switch the output is zero within 20 ms and stays zero") {
    const OutputLimits limits;
    LimiterState state;
    const OutputCommand full{Vec3(100, 0, 0), Vec3(0, 100, 0)};
    for (int i = 0; i < 2000; ++i) limit_output(limits, state, full, true, 1e-3);
    CHECK(glm::length(state.force) == doctest::Approx(limits.force));
    for (int i = 0; i < 20; ++i) limit_output(limits, state, full, false, 1e-3);
    CHECK(glm::length(state.force) == doctest::Approx(0.0));
    CHECK(glm::length(state.torque) == doctest::Approx(0.0));
    for (int i = 0; i < 100; ++i) limit_output(limits, state, full, false, 1e-3);
    CHECK(state.force == Vec3(0.0));
}

TEST_CASE("Limiter: the ramp has half the strength after half its time") {
    const OutputLimits limits;
    LimiterState state;
    for (int i = 0; i < 250; ++i) limit_output(limits, state, {Vec3(10, 0, 0), Vec3(0.0)}, true, 1e-3);
    CHECK(state.force.x == doctest::Approx(5.0).epsilon(0.01));
}

TEST_CASE("Limiter: a device without torque output gets no torque") {
    OutputLimits limits;
    limits.torque = 0.0;
    LimiterState state;
    for (int i = 0; i < 1000; ++i)
        CHECK(limit_output(limits, state, {Vec3(0.0), Vec3(0, 1, 0)}, true, 1e-3).torque == Vec3(0.0));
}

}  // namespace force_limiter_test
