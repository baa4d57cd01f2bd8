// Checks the device's samples. On a fault the output goes to zero, the fault is reported, and after a time
// without faults the output ramps up again. Only the emergency stop latches.
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/pose.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::force {

enum class Fault : std::uint8_t {
    none,
    silent,       // no sample for longer than OutputLimits::silence
    no_pose,      // the pose is not finite or has no unit quaternion
    jumped,       // moved further than a hand can in a tick
    too_fast,     // faster than OutputLimits::speed: a runaway or a falling device
    bad_request,  // the requested force is not finite
    stopped,      // emergency stop
};
inline constexpr std::size_t fault_kinds = 7;
const char* name(Fault fault);

// The state of the device in this tick.
struct PortInput {
    Pose pose;                 // of the point of application of the force, in the force's frame
    bool valid = true;         // the sample is a pose
    bool fresh = true;         // a sample arrived since the last tick
    std::uint32_t missed = 0;  // deadlines without a tick since the last tick
    bool enabled = false;      // dead-man switch held
    bool stop = false;         // emergency stop pressed
    bool reset = false;        // releases the stop if neither dead-man switch nor stop is pressed
};

// Motion of the device since the previous sample.
struct Motion {
    Vec3 shift{0.0};             // m
    Vec3 turn{0.0};              // rad
    Vec3 velocity{0.0};          // m/s, smoothed over 1.5 ms
    Vec3 angular_velocity{0.0};  // rad/s
    bool fresh = false;          // a new sample; false: shift and turn are of an earlier one
    bool begins = false;         // the first sample: it starts a motion and has none itself
};

struct WatchdogState {
    Fault fault = Fault::none;                        // reason for which the output is held at zero
    std::array<std::uint64_t, fault_kinds> counts{};  // occurrences of each fault
    std::uint64_t quiet = 0;                          // ticks since the last sample
    std::uint64_t sound = 0;                          // ticks without a fault since the last one
    bool known = false;                               // `last` is valid
    Pose last;
    Motion motion;
    Vec3 mean_velocity{0.0},
        mean_angular_velocity{0.0};  // smoothed over 5 ms; compared with the speed limits
};

// One tick of dt. Returns true if the output may be rendered. `request_is_sound`: the requested force is
// finite.
bool watch(const OutputLimits& limits, WatchdogState& state, const PortInput& input, bool request_is_sound,
           double dt);

}  // namespace bolt::force
