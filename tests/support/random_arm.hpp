// Random arms for stability tests. The chosen ranges extend from a relaxed grip of two fingers to a tense
// arm; a light hand with little damping is the difficult case.
#pragma once

#include <cmath>

#include "engine/base/random.hpp"
#include "haptics/device/simulated_arm.hpp"

namespace bolt::test {

using device::ArmModel;
using device::encoder_pose;
using device::HandAndArmParameters;
using device::step;

inline HandAndArmParameters random_arm(Random& random) {
    const auto logarithmic = [&](double low, double high) {
        return low * std::pow(high / low, random.uniform());
    };
    HandAndArmParameters p;
    p.mass = logarithmic(0.08, 1.5);
    p.damping = logarithmic(1.0, 25.0);
    p.stiffness = logarithmic(40.0, 1000.0);
    p.inertia = logarithmic(4e-4, 6e-3);
    p.angular_damping = logarithmic(4e-3, 0.15);
    p.angular_stiffness = logarithmic(0.3, 6.0);
    p.friction = random.uniform(0.0, 0.2);
    p.angular_friction = random.uniform(0.0, 2e-3);
    p.encoder = logarithmic(2e-6, 30e-6);
    p.angular_encoder = logarithmic(2e-5, 3e-4);
    return p;
}

}  // namespace bolt::test
