// A simulated arm that holds a force-feedback device, for stability tests: the servo samples its motion,
// delayed and quantised, and its forces move the arm.
//
// The hand is a mass, a damper and a spring to its intended pose, the model of Hogan (Controlling impedance
// at the man/machine interface, ICRA 1989). The chosen ranges extend from a relaxed grip of two fingers to a
// tense arm; a light hand with little damping is the difficult case.
#pragma once

#include <array>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::test {

struct ArmParameters {
    double mass = 0.3;               // kg, hand and device
    double damping = 5.0;            // N·s/m
    double stiffness = 300.0;        // N/m
    double inertia = 2e-3;           // kg·m²
    double angular_damping = 0.03;   // N·m·s/rad
    double angular_stiffness = 2.0;  // N·m/rad
    double friction = 0.05;          // N, of the device
    double angular_friction = 1e-3;  // N·m
    double encoder = 10e-6;          // m, one step
    double angular_encoder = 1e-4;   // rad
    int delay = 1;                   // ticks from sending to effect, at most 3
};

ArmParameters random_arm(Random& random);

struct Arm {
    ArmParameters parameters;
    Pose pose;       // of the tool
    Pose intention;  // intended pose
    Vec3 velocity{0.0};
    Vec3 angular_velocity{0.0};
    double energy_out = 0.0;  // J delivered to the hand: force times motion, integrated every 25 µs
    std::array<force::OutputCommand, 4> sent{};
};

Pose sample(const Arm& arm);
void step(Arm& arm, const force::OutputCommand& command, double dt);

}  // namespace bolt::test
