// Limits of a force-feedback device, from its description, and the command that it receives.
#pragma once

#include <algorithm>
#include <optional>

#include "engine/base/math.hpp"

namespace bolt::force {

struct OutputCommand {
    Vec3 force{0.0};   // N, on the hand
    Vec3 torque{0.0};  // N·m
};

// The defaults are the published values of a 6-DoF arm such as Haption's Virtuose; speeds and jumps are
// chosen above those of deliberate hand motion.
struct OutputLimits {
    double force = 20.0;              // N, magnitude
    double torque = 2.0;              // N·m, magnitude; 0: no torque output
    double force_slew_rate = 2000.0;  // N/s, slew rate while rendering
    double torque_slew_rate = 200.0;  // N·m/s, slew rate while rendering
    double ramp_up = 0.5;             // s from closing the dead-man switch to the full force
    double release = 0.02;            // s from releasing the dead-man switch to zero output, at most

    double stiffness = 2000.0;     // N/m, largest stiffness that the device renders stably
    double torsion = 40.0;         // N·m/rad, largest torsional stiffness, likewise
    double damping = 20.0;         // N·s/m that the device renders without oscillation; 0: no damping
    double angular_damping = 0.1;  // N·m·s/rad
    int delay = 1;                 // ticks from a command to the force on the hand, 0 … 3

    double speed = 3.0;           // m/s above which the output is held at zero
    double angular_speed = 50.0;  // rad/s
    double jump = 0.03;           // m in one tick; more is a faulty sample
    double angular_jump = 0.5;    // rad in one tick
    // s without a sample after which the output falls. It is zero at the latest when `release` seconds have
    // passed since the last sample.
    double max_silence = 0.008;
    double recovery_time = 0.1;  // s of valid samples after a fault before the output ramps up
};

// Limits the length of `v` to `max_length`; zero if `max_length` is not positive. Scaled before glm::length
// so that the square of a huge finite component does not overflow and yield NaN.
inline Vec3 clamp_length(const Vec3& v, double max_length) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (largest == 0.0 || max_length <= 0.0) return Vec3(0.0);
    const Vec3 unit = v / largest;
    const double length = largest * glm::length(unit);
    return length <= max_length ? v : unit * (max_length / glm::length(unit));
}

// Weaker limits, for trainees who need weaker forces: multiplies the limits of force and torque and their
// rates by `scale`, clamped to 0 … 1; NaN counts as 0. Stiffness, damping, speeds and times are unchanged.
inline OutputLimits scaled(const OutputLimits& limits, double scale) {
    const double share = scale > 0.0 ? std::min(scale, 1.0) : 0.0;
    OutputLimits less = limits;
    for (double OutputLimits::*limit : {&OutputLimits::force, &OutputLimits::torque,
                                        &OutputLimits::force_slew_rate, &OutputLimits::torque_slew_rate})
        less.*limit *= share;
    return less;
}

// Upper bounds that the person who installs a station sets for a device (station file); none: the device's
// own limit. Units as in OutputLimits.
struct LimitBounds {
    std::optional<double> force, torque;
    std::optional<double> stiffness, torsion;
    std::optional<double> damping, angular_damping;
    bool operator==(const LimitBounds&) const = default;
};

// The limits, lowered to the bounds. A bound that is above its limit, negative or NaN has no effect, so a
// bound never raises a limit.
inline OutputLimits lowered(const OutputLimits& limits, const LimitBounds& bounds) {
    OutputLimits lower = limits;
    const auto lower_to = [](double& limit, const std::optional<double>& bound) {
        if (bound && *bound >= 0.0) limit = std::min(limit, *bound);
    };
    lower_to(lower.force, bounds.force);
    lower_to(lower.torque, bounds.torque);
    lower_to(lower.stiffness, bounds.stiffness);
    lower_to(lower.torsion, bounds.torsion);
    lower_to(lower.damping, bounds.damping);
    lower_to(lower.angular_damping, bounds.angular_damping);
    return lower;
}

}  // namespace bolt::force
