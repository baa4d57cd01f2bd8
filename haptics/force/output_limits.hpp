// What a force-feedback device takes and renders, as its description says, and what is sent to it.
#pragma once

#include <algorithm>

#include "engine/base/math.hpp"

namespace bolt::force {

struct OutputCommand {
    Vec3 force{0.0};   // N, on the hand
    Vec3 torque{0.0};  // N·m
};

// The defaults are those of a 6-DoF arm as the Virtuose class has them, where its maker publishes them;
// speeds are what no hand does on purpose.
struct OutputLimits {
    double force = 20.0;         // N, magnitude
    double torque = 2.0;         // N·m, magnitude; 0: the device has none
    double force_rate = 2000.0;  // N/s, while rendering
    double torque_rate = 200.0;  // N·m/s
    double ramp_up = 0.5;        // s from enabling to full strength
    double release = 0.02;       // s: with the dead-man let go everything is zero after at most this time

    double stiffness = 2000.0;     // N/m that it renders stably
    double torsion = 40.0;         // N·m/rad
    double damping = 20.0;         // N·s/m that it takes without trembling; 0: nothing may be damped
    double angular_damping = 0.1;  // N·m·s/rad
    int delay = 1;                 // ticks from sending a force to the hand having it, 0 … 3

    double speed = 3.0;           // m/s, above it the output is held off
    double angular_speed = 50.0;  // rad/s
    double jump = 0.03;           // m in one tick: no hand, whatever the sample says
    double angular_jump = 0.5;    // rad in one tick
    double silence = 0.008;       // s without a new sample; `release` counts from the last one
    double recovery = 0.1;        // s of sound samples after a fault before the output ramps up again
};

// Not glm::length: a huge but finite component must not overflow to infinity and so slip through as NaN.
inline Vec3 at_most(const Vec3& v, double most) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest == 0.0 || most <= 0.0) return Vec3(0.0);
    const Vec3 unit = v / largest;
    const double length = largest * glm::length(unit);
    return length <= most ? v : unit * (most / glm::length(unit));
}

}  // namespace bolt::force
