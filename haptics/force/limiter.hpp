// The last step of the output stage. Its output is finite, within the device's limits, and within the slew
// rates.
#pragma once

#include <cstdint>

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

struct OutputState {
    Vec3 force{0.0};
    Vec3 torque{0.0};
    double strength = 0.0;     // 0 … 1, ramp after enabling
    std::uint64_t faults = 0;  // steps with a request that was not finite
};

// One step of dt. Returns the device's command, which is also stored in the state. If not `enabled`, or if
// the request is not finite, the output falls to zero within `release` seconds.
OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& requested,
                           bool enabled, double dt, double release);

inline OutputCommand limit_output(const OutputLimits& limits, OutputState& state,
                                  const OutputCommand& requested, bool enabled, double dt) {
    return limit_output(limits, state, requested, enabled, dt, limits.release);
}

}  // namespace bolt::force
