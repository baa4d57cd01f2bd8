// Reduces a device's forces, for trainees who need weaker ones.
#pragma once

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

// Multiplies the limits of force and torque and their rates by `scale`, clamped to 0 … 1; NaN counts as 0.
// Stiffness, damping, speeds and times are unchanged.
inline OutputLimits scaled(const OutputLimits& limits, double scale) {
    const double share = scale > 0.0 ? std::min(scale, 1.0) : 0.0;
    OutputLimits less = limits;
    for (double OutputLimits::*limit :
         {&OutputLimits::force, &OutputLimits::torque, &OutputLimits::force_rate, &OutputLimits::torque_rate})
        less.*limit *= share;
    return less;
}

}  // namespace bolt::force
