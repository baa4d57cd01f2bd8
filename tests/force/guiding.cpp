#include <doctest/doctest.h>

#include <limits>

#include "engine/base/random.hpp"
#include "haptics/force/guiding.hpp"
#include "haptics/force/limiter.hpp"

using namespace bolt;
using namespace bolt::force;

TEST_CASE("guiding force: k/d outside d_min, K d inside, continuous between, never above the root of k K") {
    const Guiding g{0.02, 800.0, 0.5};
    const double d_min = std::sqrt(0.02 / 800.0);
    const auto at = [&](double d) { return guiding_force(g, Vec3(d, 0, 0), Vec3(0.0)).x; };
    CHECK(at(0.1) == doctest::Approx(-0.2));
    CHECK(at(0.5 * d_min) == doctest::Approx(-800.0 * 0.5 * d_min));
    CHECK(at(d_min * (1 - 1e-9)) == doctest::Approx(at(d_min * (1 + 1e-9))));
    CHECK(at(0.0) == 0.0);
    for (double d = 1e-6; d < 2.0; d *= 1.01) {
        CHECK(std::abs(at(d)) <= std::sqrt(0.02 * 800.0) * (1 + 1e-12));
        CHECK(at(d) <= 0.0);
    }
    CHECK(at(1.0) == 0.0);  // too far to be led
}

TEST_CASE("what leaves the output stage is inside the limits and the slew rate, whatever goes in") {
    const OutputLimits limits;
    Random random(4);
    OutputState state;
    constexpr double dt = 1e-3;
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
        // While rendering the force slews; letting go may be faster, never slower.
        const double most = std::max(limits.force_rate, limits.force / limits.release) * dt;
        REQUIRE(glm::length(out.force - last) <= most * (1 + 1e-9));
        last = out.force;
    }
    CHECK(state.faults > 0);
}

TEST_CASE("letting go of the dead-man: zero within 20 ms from full output, and it stays zero") {
    const OutputLimits limits;
    OutputState state;
    const OutputCommand full{Vec3(100, 0, 0), Vec3(0, 100, 0)};
    for (int i = 0; i < 2000; ++i) limit_output(limits, state, full, true, 1e-3);
    CHECK(glm::length(state.force) == doctest::Approx(limits.force));
    for (int i = 0; i < 20; ++i) limit_output(limits, state, full, false, 1e-3);
    CHECK(glm::length(state.force) == doctest::Approx(0.0));
    CHECK(glm::length(state.torque) == doctest::Approx(0.0));
    for (int i = 0; i < 100; ++i) limit_output(limits, state, full, false, 1e-3);
    CHECK(state.force == Vec3(0.0));
}

TEST_CASE("enabling ramps up: half the strength after half the time") {
    const OutputLimits limits;
    OutputState state;
    for (int i = 0; i < 250; ++i) limit_output(limits, state, {Vec3(10, 0, 0), Vec3(0.0)}, true, 1e-3);
    CHECK(state.force.x == doctest::Approx(5.0).epsilon(0.01));
}

TEST_CASE("a device without torque gets none") {
    OutputLimits limits;
    limits.torque = 0.0;
    OutputState state;
    for (int i = 0; i < 1000; ++i)
        CHECK(limit_output(limits, state, {Vec3(0.0), Vec3(0, 1, 0)}, true, 1e-3).torque == Vec3(0.0));
}
