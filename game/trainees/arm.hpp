// How a hand gives way to what it feels: a mass, a damper and a spring between where it means to be and where
// it is (Hogan, Impedance control, ASME J. Dyn. Syst. Meas. Control 107 (1985) 1). What a hand does by itself
// it does without lag, as a practised reach is; only forces drive it away from there.
#pragma once

#include "engine/base/pose.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::trainees {

// Of a hand that holds a wrench. Chosen, not measured: within the ranges that tests/stability tries the
// device with, damped at 0.7 of critical. The greatest force is meant for somebody who reaches and does not
// lean.
struct Impedance {
    double mass = 0.5;               // kg
    double damping = 17.0;           // N·s/m
    double stiffness = 300.0;        // N/m
    double force = 6.0;              // N, what its spring pushes at most
    double inertia = 5e-3;           // kg·m²
    double angular_damping = 0.14;   // N·m·s/rad
    double angular_stiffness = 2.0;  // N·m/rad
    double torque = 0.6;             // N·m
};

struct Arm {
    Vec3 offset{0.0}, velocity{0.0};  // m, m/s: from where the hand means to be
    Vec3 turn{0.0}, rate{0.0};        // rad, rad/s, as rotation vectors
};

// The hand is at `pose` and means to be at `meant`: nothing moves by that.
void take_up(Arm& arm, const Pose& pose, const Pose& meant);

// One tick: where the hand is. `grips`: it has hold of a nut, puts in what it feels and gives way to nothing;
// what it was away from its meaning fades.
Pose follow(const Impedance& impedance, Arm& arm, const Pose& meant, const force::OutputCommand& felt,
            bool grips, double dt);

}  // namespace bolt::trainees
