// The last step of the output stage: what leaves it is finite, inside what the device takes, and changes no
// faster than the device and the hand take.
#pragma once

#include <cstdint>

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

struct OutputState {
    Vec3 force{0.0};
    Vec3 torque{0.0};
    double strength = 0.0;     // 0…1, the ramp
    std::uint64_t faults = 0;  // steps in which something not finite was asked for
};

// One step of dt. Returns what may go to the device; also kept in the state. Not enabled: down to zero from
// whatever it was, within `release` seconds.
OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& wanted,
                           bool enabled, double dt, double release);

inline OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& wanted,
                                  bool enabled, double dt) {
    return limit_output(limits, state, wanted, enabled, dt, limits.release);
}

}  // namespace bolt::force
