#include "haptics/force/output_limits.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "engine/base/random.hpp"
#include "haptics/force/output_stage.hpp"

using namespace bolt;
using namespace bolt::force;

TEST_CASE("Scaled limits: limits of force and torque are scaled, all others unchanged") {
    const OutputLimits whole;
    for (const double share : {0.1, 0.35, 0.5, 1.0}) {
        const OutputLimits less = scaled(whole, share);
        CHECK(less.force == doctest::Approx(share * 20.0));
        CHECK(less.torque == doctest::Approx(share * 2.0));
        CHECK(less.force_slew_rate == doctest::Approx(share * 2000.0));
        CHECK(less.torque_slew_rate == doctest::Approx(share * 200.0));
        CHECK(less.stiffness == whole.stiffness);
        CHECK(less.torsion == whole.torsion);
        CHECK(less.damping == whole.damping);
        CHECK(less.angular_damping == whole.angular_damping);
        CHECK(less.speed == whole.speed);
        CHECK(less.ramp_up == whole.ramp_up);
        CHECK(less.release == whole.release);
        CHECK(less.max_silence == whole.max_silence);
    }
}

TEST_CASE("Scaled limits: they never exceed the device's own limits") {
    const OutputLimits whole;
    constexpr double inf = std::numeric_limits<double>::infinity();
    for (const double asked : {1.0 + 1e-12, 2.0, 1e300, inf})
        CHECK(scaled(whole, asked).force == whole.force);
    for (const double asked : {0.0, -0.0, -1.0, -inf, std::nan("")}) {
        CHECK(scaled(whole, asked).force == 0.0);
        CHECK(scaled(whole, asked).torque_slew_rate == 0.0);
    }
    OutputLimits no_torque = whole;
    no_torque.torque = 0.0;
    CHECK(scaled(no_torque, 0.5).torque == 0.0);
}

TEST_CASE("Scaled limits: the limiter obeys them") {
    const OutputLimits less = scaled(OutputLimits{}, 0.25);
    LimiterState state;
    double before = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const OutputCommand out =
            limit_output(less, state, {Vec3(100.0, 0.0, 0.0), Vec3(0.0, 100.0, 0.0)}, true, 1e-3);
        CHECK(glm::length(out.force) <= 5.0 + 1e-12);
        CHECK(glm::length(out.torque) <= 0.5 + 1e-12);
        CHECK(out.force.x - before <= 0.5 + 1e-12);
        before = out.force.x;
    }
    CHECK(before == doctest::Approx(5.0));
}

TEST_CASE("Lowered limits: each limit is the lower of the device's own and the bound, and the others stay") {
    Random random(5);
    constexpr double OutputLimits::*limits[] = {&OutputLimits::force,     &OutputLimits::torque,
                                                &OutputLimits::stiffness, &OutputLimits::torsion,
                                                &OutputLimits::damping,   &OutputLimits::angular_damping};
    constexpr std::optional<double> LimitBounds::*bounds[] = {
        &LimitBounds::force,   &LimitBounds::torque,  &LimitBounds::stiffness,
        &LimitBounds::torsion, &LimitBounds::damping, &LimitBounds::angular_damping};
    const double strange[] = {bolt::nan, -1.0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < 1000; ++i) {
        OutputLimits own;
        LimitBounds bound;
        for (std::size_t k = 0; k < std::size(limits); ++k) {
            own.*limits[k] = random.chance(0.1) ? 0.0 : random.uniform(0.0, 100.0);
            if (random.chance(0.7)) bound.*bounds[k] = random.uniform(0.0, 100.0);
            if (random.chance(0.1)) bound.*bounds[k] = strange[random.bits() % 3];
        }
        const OutputLimits less = lowered(own, bound);
        for (std::size_t k = 0; k < std::size(limits); ++k) {
            const double before = own.*limits[k];
            const double given = (bound.*bounds[k]).value_or(before);
            CHECK(less.*limits[k] == (given >= 0.0 && given < before ? given : before));
        }
        CHECK(less.force_slew_rate == own.force_slew_rate);
        CHECK(less.speed == own.speed);
        CHECK(less.max_silence == own.max_silence);
    }
}
