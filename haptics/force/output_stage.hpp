// The output stage: every force passes through it before a device renders it. Its parts, in order:
// watchdog (permits or blocks the output), passivity observer and controller, limiter (ramp, slew rate,
// clamp, release).
#pragma once

#include <array>
#include <cstdint>

#include "engine/base/math.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::force {

// The watchdog checks the device's samples. On a fault the output goes to zero, the fault is reported, and
// after a time without faults the output ramps up again. Only the emergency stop latches.

enum class Fault : std::uint8_t {
    none,
    silent,       // no sample for longer than OutputLimits::max_silence
    no_pose,      // the pose is not finite or has no unit quaternion
    jumped,       // moved further than a hand can in a tick
    too_fast,     // faster than OutputLimits::speed: a runaway or a falling device
    bad_request,  // the requested force or one of its energies is not finite
    stopped,      // emergency stop
};
inline constexpr std::size_t fault_kinds = 7;
const char* message_for(Fault fault);

// The state of the device in this tick.
struct DeviceInput {
    Pose pose;                 // of the point of application of the force, in the force's frame
    bool valid = true;         // the sample is a pose
    bool fresh = true;         // a sample arrived since the last tick
    std::uint32_t missed = 0;  // deadlines without a tick since the last tick
    bool dead_man = false;     // the dead-man switch is held
    bool stop = false;         // emergency stop pressed
    bool reset = false;        // releases the stop if neither dead-man switch nor stop is pressed
};

// Motion of the device since the previous sample.
struct Motion {
    Vec3 shift{0.0};             // m
    Vec3 rotation{0.0};          // rad, axis times angle
    Vec3 velocity{0.0};          // m/s, smoothed over 1.5 ms
    Vec3 angular_velocity{0.0};  // rad/s
    bool fresh = false;          // a new sample; false: shift and rotation are of an earlier one
    bool first = false;          // this is the first valid sample; there is no motion since a previous one
};

struct WatchdogState {
    Fault fault = Fault::none;                        // reason for which the output is held at zero
    std::array<std::uint64_t, fault_kinds> counts{};  // occurrences of each fault
    std::uint64_t ticks_since_sample = 0;             // ticks since the last sample
    std::uint64_t ticks_without_fault = 0;            // since the cause of `fault` has gone
    bool has_last = false;                            // `last` is valid
    Pose last;
    Motion motion;
    // m/s and rad/s, smoothed over 5 ms; compared with the speed limits.
    Vec3 mean_velocity{0.0}, mean_angular_velocity{0.0};
};

// The watchdog. One tick of dt. Returns true if no fault blocks the output; render() checks the dead-man
// switch. `request_is_finite`: the requested force and its energies are finite.
bool update_watchdog(const OutputLimits& limits, WatchdogState& state, const DeviceInput& input,
                     bool request_is_finite, double dt);

// Time-domain passivity control: observes the energy at the device's port and removes energy that the
// rendering generates. A sampled, delayed and slew-limited spring returns more energy than the hand put in,
// and the hand feels the excess as vibration.
//
// Hannaford, Ryu: Time-domain passivity control of haptic interfaces. IEEE Trans. Robotics and Automation
// 18(1), 2002. The stored energy is the reference, as in Ryu, Preusche, Hannaford, Hirzinger: Time domain
// passivity control with reference energy following. IEEE Trans. Control Systems Technology 13(5), 2005.

// A requested command with its energy. Both energies may be 0; then the controller permits only energy that
// the hand put in shortly before.
struct ForceRequest {
    OutputCommand command;
    double stored_energy = 0.0;    // J in the springs that make the command; must not be overestimated
    double injected_energy = 0.0;  // J that enters in this tick without work of the hand, as by guiding
};

struct PassivityState {
    // J that the hand put in and did not get back, less the stored energy. Negative: energy was generated.
    double balance = 0.0;
    double stored_energy = 0.0;  // J, of the last request
    double removed = 0.0;        // J removed by the controller since the start
    double damping = 0.0;        // 0 … 1, of damping_share × OutputLimits::damping

    std::array<OutputCommand, 4> sent{};  // commands sent, newest first
    OutputCommand applied;                // sum of the commands of the ticks since the last sample
    double ticks = 0.0;                   // number of these ticks
};

// Share of OutputLimits::damping that is used: damping is sampled and delayed as well (Colgate, Schenkel
// 1997).
inline constexpr double damping_share = 0.9;

// Largest positive balance, J, and time constant of its decay, s: energy dissipated long ago must not offset
// energy that a vibration generates now. With 0.5 mJ, in a trial, a tool that rocked on a ball-shaped
// obstacle vibrated for one second. A spring of 1 N/mm pressed at 0.3 m/s at 1 kHz generates 45 µJ per tick,
// so 0.2 mJ prevents a reaction to single ticks.
inline constexpr double max_credit = 0.2e-3;
inline constexpr double credit_decay_time = 0.03;

// 1/s, rates at which damping sets in and ends. A step of damping would itself be a jolt of up to 2 N at 0.1
// m/s; energy that is not removed at once is removed a few milliseconds later.
inline constexpr double damping_rise_rate = 60.0, damping_fall_rate = 40.0;

// The observer: adds the work of the applied commands along the motion since the last sample. `ticks`:
// periods that passed, missed deadlines included.
void add_applied_work(const OutputLimits& limits, PassivityState& state, const Motion& motion, double ticks);

// The controller: returns the command, clamped and with as much damping as the deficit needs and the device
// permits. `ramp` is that of this tick (LimiterState), `ramp_before` that of the last one.
OutputCommand control_passivity(const OutputLimits& limits, PassivityState& state, const Motion& motion,
                                const ForceRequest& request, double ramp, double ramp_before, double dt);

// Stores the command that was sent, for add_applied_work() in the ticks in which it acts on the hand. Call at
// the end of each tick.
void record_sent(PassivityState& state, const OutputCommand& sent);

// The limiter, the last step. Its output is finite, within the device's limits and within the slew
// rates. While the output falls to zero the slew rates do not apply.

struct LimiterState {
    Vec3 force{0.0};    // N, last output
    Vec3 torque{0.0};   // N·m
    double ramp = 0.0;  // 0 … 1, rendered share of the request; grows while the dead-man switch is held
    std::uint64_t invalid_requests = 0;  // steps with a request that was not finite
};

// One step of dt. Returns the device's command, which is also stored in the state. If not `enabled`, or if
// the request is not finite, the output falls to zero within `release` seconds.
OutputCommand limit_output(const OutputLimits& limits, LimiterState& state, const OutputCommand& requested,
                           bool enabled, double dt, double release);

inline OutputCommand limit_output(const OutputLimits& limits, LimiterState& state,
                                  const OutputCommand& requested, bool enabled, double dt) {
    return limit_output(limits, state, requested, enabled, dt, limits.release);
}

struct OutputStage {
    WatchdogState watchdog;
    PassivityState passivity;
    LimiterState limiter;
};

// One tick of dt. Returns the device's command. It is zero at most limits.release after the dead-man switch
// is released, after the last sample of a silent device (OutputLimits::max_silence is part of that time), and
// after any other fault.
OutputCommand render(const OutputLimits& limits, OutputStage& stage, const DeviceInput& input,
                     const ForceRequest& request, double dt);

}  // namespace bolt::force
