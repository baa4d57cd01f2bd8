// A device at less than it could: for those whose hands want less of it.
#pragma once

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

// Every limit of force and torque, and of how fast they change, as a share `scale` of what it is; never more
// than that, whatever `scale` says: above 1 it is 1, and below 0 or no number it is 0. What the device
// renders stably, its speeds and its times are as they were.
inline OutputLimits scaled(const OutputLimits& limits, double scale) {
    const double share = scale > 0.0 ? std::min(scale, 1.0) : 0.0;
    OutputLimits less = limits;
    for (double OutputLimits::*limit :
         {&OutputLimits::force, &OutputLimits::torque, &OutputLimits::force_rate, &OutputLimits::torque_rate})
        less.*limit *= share;
    return less;
}

}  // namespace bolt::force
