#include "tests/support/random_arm.hpp"

#include <cmath>

namespace bolt::test {

namespace {

double logarithmic(Random& random, double low, double high) {
    return low * std::pow(high / low, random.uniform());
}

}  // namespace

ArmParameters random_arm(Random& random) {
    ArmParameters p;
    p.mass = logarithmic(random, 0.08, 1.5);
    p.damping = logarithmic(random, 1.0, 25.0);
    p.stiffness = logarithmic(random, 40.0, 1000.0);
    p.inertia = logarithmic(random, 4e-4, 6e-3);
    p.angular_damping = logarithmic(random, 4e-3, 0.15);
    p.angular_stiffness = logarithmic(random, 0.3, 6.0);
    p.friction = random.uniform(0.0, 0.2);
    p.angular_friction = random.uniform(0.0, 2e-3);
    p.encoder = logarithmic(random, 2e-6, 30e-6);
    p.angular_encoder = logarithmic(random, 2e-5, 3e-4);
    return p;
}

}  // namespace bolt::test
