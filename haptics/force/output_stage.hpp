// The one place where forces are limited. Whatever is computed before it, what leaves it is finite, inside
// what the device takes, and changes no faster than the device and the hand take. Nothing else writes to a
// device.
#pragma once

#include <cstdint>

#include "engine/base/math.hpp"

namespace bolt::force {

// From the device's description.
struct OutputLimits {
    double force = 20.0;         // N, magnitude
    double torque = 2.0;         // N·m, magnitude; 0: the device has none
    double force_rate = 2000.0;  // N/s, while rendering
    double torque_rate = 200.0;  // N·m/s
    double ramp_up = 0.5;        // s from enabling to full strength
    double release = 0.02;       // s: with the dead-man let go everything is zero after at most this time
};

struct OutputState {
    Vec3 force{0.0};
    Vec3 torque{0.0};
    double strength = 0.0;     // 0…1, the ramp
    std::uint64_t faults = 0;  // steps in which something not finite was asked for
};

struct OutputCommand {
    Vec3 force{0.0};
    Vec3 torque{0.0};
};

// One step of dt. Returns what may go to the device; also kept in the state.
OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& wanted,
                           bool enabled, double dt);

}  // namespace bolt::force
