// The visible effort of a hand: proportional to its pull, smooth, and zero at rest.
#include "game/scene/postures.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/support/haptic_world.hpp"

using namespace bolt;
using namespace bolt::scene;

namespace {

servo::Setup some_setup() {
    servo::Setup setup;
    setup.wrench.stiffness = 1000.0;
    setup.nuts.emplace_back();
    setup.nuts.back().across_flats = 0.013;
    return setup;
}

const world::World& pulling(double torque, bool wrench = true) {
    static test::HapticWorld world(1);
    servo::Output output;
    output.joint = 0;
    output.wrench_torque = torque;
    return world.write(output, wrench);
}

}  // namespace

TEST_CASE("Effort: a steady pull gives its share of the greatest torque in both directions, without tremor") {
    const servo::Setup setup = some_setup();
    const double most = 1000.0 * to_radians(2.5);
    for (const double share : {-1.0, -0.4, 0.25, 1.0}) {
        Effort s;
        for (int i = 0; i < 2000; ++i) update_effort(s, setup, pulling(share * most));
        CHECK(s.share == doctest::Approx(std::abs(share)).epsilon(1e-6));
        CHECK(s.tremor == doctest::Approx(0.0).epsilon(1e-6));
    }
    // Fingers: half their force times the nut's width.
    CHECK(relative_torque(setup, pulling(0.5 * 65.0 * 0.013, false)) == doctest::Approx(1.0));
    CHECK(relative_torque(setup, pulling(1e6)) == 1.0);
}

TEST_CASE(
    "Effort: it follows a torque step as a first-order lag, an oscillation causes tremor, and both decay to "
    "zero at rest") {
    const servo::Setup setup = some_setup();
    const double most = 1000.0 * to_radians(2.5);
    Effort s;
    double before = 0.0, tremor_before = 0.0, trembled = 0.0;
    for (int i = 1; i <= 400; ++i) {
        update_effort(s, setup, pulling(0.5 * most));
        CHECK(s.share == doctest::Approx(0.5 * (1.0 - std::exp(-i * 1e-3 / 0.09))).epsilon(1e-9));
        CHECK(s.share > before);
        CHECK(std::abs(s.tremor - tremor_before) < 0.2);  // no jump in a tick
        before = s.share;
        tremor_before = s.tremor;
    }
    for (int i = 0; i < 1000; ++i) {
        update_effort(s, setup, pulling(most * (0.5 + 0.02 * std::sin(2.0 * pi * 9.0 * i * 1e-3))));
        if (i > 500) trembled = std::max(trembled, std::abs(s.tremor));
    }
    CHECK(trembled > 0.05);
    CHECK(trembled < 0.3);
    test::HapticWorld at_rest(1);
    for (int i = 0; i < 1500; ++i) update_effort(s, setup, at_rest.write({}));
    CHECK(s.share == 0.0);
    CHECK(s.tremor == 0.0);
    CHECK(s.slow == 0.0);
}
