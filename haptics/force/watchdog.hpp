// Whether what the device says can be rendered upon. What cannot is held off: the output goes to zero,
// somebody can read why, and when all has been well for a while it ramps up again. The emergency stop alone
// latches.
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/pose.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::force {

enum class Fault : std::uint8_t {
    none,
    silent,       // no new sample for longer than a device may be quiet
    no_pose,      // not finite, or no rotation
    jumped,       // further than a hand goes in a tick
    too_fast,     // a runaway, or a device let fall
    bad_request,  // a force was wanted that is no number
    stopped,      // the emergency stop
};
inline constexpr std::size_t fault_kinds = 7;
const char* name(Fault fault);

// The device in this tick.
struct PortInput {
    Pose pose;                 // of the point that the force acts on, in the frame that the force is in
    bool valid = true;         // the sample was a pose
    bool fresh = true;         // a sample that the tick before did not have
    std::uint32_t missed = 0;  // deadlines without a tick since the last one
    bool enabled = false;      // dead-man held
    bool stop = false;         // emergency stop pressed
    bool reset = false;        // asks for the stop's end: heard with the dead-man and the stop let go
};

// How the device moved since the sample before this one.
struct Motion {
    Vec3 shift{0.0};             // m
    Vec3 turn{0.0};              // rad
    Vec3 velocity{0.0};          // m/s, smoothed over 1.5 ms
    Vec3 angular_velocity{0.0};  // rad/s
    bool fresh = false;          // false: nothing new is known
    bool begins = false;         // the first sample: what was before it is no motion
};

struct WatchdogState {
    Fault fault = Fault::none;                        // why the output is held off
    std::array<std::uint64_t, fault_kinds> counts{};  // how often each held it off
    std::uint64_t quiet = 0;                          // ticks since the last sample
    std::uint64_t sound = 0;                          // ticks without a fault
    bool known = false;                               // `last` is a pose
    Pose last;
    Motion motion;
    Vec3 mean_velocity{0.0}, mean_angular_velocity{0.0};  // smoothed over 5 ms: what the speed limits hold
};

// One tick of dt. Returns whether the output may be rendered; `request_is_sound`: the wanted force is a
// number.
bool watch(const OutputLimits& limits, WatchdogState& state, const PortInput& input, bool request_is_sound,
           double dt);

}  // namespace bolt::force
