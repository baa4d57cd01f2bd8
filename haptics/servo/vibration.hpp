// Vibration of a hand controller, computed from what a tick publishes. Vibration cannot
// replace a force, so it says nothing that picture and sound do not show as well. Pure: no clock, no
// allocation, no I/O; equal inputs give equal bits. docs/vibration.md has the table of cues.
//
//   advance_vibration(state, options, input, dt);        // each tick
//   if (const auto command = next_vibration(state, options)) ...   // each frame
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "engine/base/math.hpp"
#include "haptics/joint/stage.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::servo {

// In ascending rank. All but `load_pulse` are events, which give one command each.
enum class VibrationCue : std::uint8_t {
    load_pulse,  // repeated while the load grows or a loaded nut turns
    detent,      // the unloaded nut has turned by VibrationOptions::detent_angle
    strike,      // the wrench has struck something
    breakaway,   // a loaded nut that stood still begins to turn
    seat,        // the nut has reached its seat
    yield,       // the bolt begins to yield
    slip,        // the jaw has slipped over the corners
    click,       // the torque wrench has clicked
};
inline constexpr std::size_t vibration_cue_count = 8;

struct VibrationPulse {
    double amplitude = 0.0;  // 0 … 1
    double frequency = 0.0;  // Hz
    double duration = 0.0;   // s
};

struct VibrationOptions {
    double gain = 1.0;  // 0 … 1, factor of all amplitudes; 0: off

    VibrationPulse detent{0.25, 170.0, 0.012};
    VibrationPulse strike{0.8, 200.0, 0.03};      // at full_strike; slower strikes in proportion
    VibrationPulse breakaway{0.7, 140.0, 0.025};  // at the target torque
    VibrationPulse seat{0.7, 100.0, 0.05};
    VibrationPulse yield{0.9, 55.0, 0.15};
    VibrationPulse slip{0.95, 80.0, 0.08};
    VibrationPulse click{1.0, 230.0, 0.03};
    // At the target torque. Each pulse lasts longer than a frame, so that there are no gaps between pulses.
    VibrationPulse load_pulse{0.6, 120.0, 0.03};
    double yield_frequency = 60.0;  // Hz, of `load_pulse` in the yield stage

    double detent_angle = to_radians(30.0);  // rad
    double full_strike = 0.5;                // m/s, speed of a strike with the full amplitude
    // Exponent of the growth of sensation with amplitude, up to 350 Hz: R. T. Verrillo et al., Subjective
    // magnitude functions for vibrotaction, IEEE Trans. Man-Machine Systems 11 (1970). Amplitude =
    // (torque / target)^(1/0.89), so that the sensation grows in proportion to torque / target.
    double sensation_exponent = 0.89;
    double max_share = 1.2;  // torque / target from which the amplitude grows no more

    // The load grows if torque / target grows by at least min_growth (1/s); the nut turns if its speed is at
    // least min_speed (rad/s). Both rates are smoothed over smoothing_time (s).
    double min_growth = 0.05, min_speed = 0.02, smoothing_time = 0.05;
    // 1/s. If torque / target falls faster than this, the hand is letting go: no load pulse.
    double release_rate = 1.0;
    double min_share = 0.1;  // torque / target below which there is no breakaway

    double min_interval = 0.01;  // s between two commands
    double max_wait =
        0.1;  // s for which an event may wait behind events of higher rank; a detent waits 0.02 s
    double min_amplitude = 0.01;  // weaker commands are not sent
};

struct VibrationCommand {
    double amplitude = 0.0;  // above 0, at most 1
    double frequency = 0.0;  // Hz
    double duration = 0.0;   // s
    VibrationCue cue = VibrationCue::load_pulse;
};

// The events and values of one tick.
struct VibrationInput {
    std::int16_t joint = -1;  // engaged joint; −1: none
    joint::Stage stage = joint::Stage::navigation;
    double torque = 0.0;        // N·m, of the wrench, either sign
    double target = 0.0;        // N·m, target torque of the step; 0: none, so there is no load to render
    double angle = 0.0;         // rad, of the nut
    bool slipped = false;       // the head slipped over the corners in this tick (Output::slipped)
    bool clicked = false;       // Output::clicked
    double strike_speed = 0.0;  // m/s at which the wrench struck something in this tick; 0: it did not
};

// The input of a tick from its output. `target`: N·m, target torque of the step. `strike_speed`: m/s, at
// which the wrench struck something; the caller determines it, because the servo does not detect strikes.
VibrationInput vibration_input(const Output& output, double target, double strike_speed);

struct VibrationState {
    // An event that no command has rendered yet.
    struct PendingCue {
        double amplitude = 0.0;  // 0: none
        double time = 0.0;       // s, when it occurred
    };

    double time = 0.0;  // s since the first tick

    // The nut of the last tick.
    std::int16_t joint = -1;
    joint::Stage stage = joint::Stage::navigation;
    double angle = 0.0, share = 0.0;  // rad, and |torque| / target
    double growth = 0.0;              // 1/s, smoothed rate of `share`
    double speed = 0.0;               // rad/s, smoothed
    double last_detent_angle = 0.0;   // rad, multiple of detent_angle
    // rad and s: the nut's angle and the time when it last moved by more than 0.02°.
    double rest_angle = 0.0, rest_since = 0.0;
    bool at_rest = false;  // the nut has stood still for 0.1 s or more

    std::int16_t seated_joint = -1;  // joint whose seat cue is not repeated; −1: none
    double seat_angle = 0.0;         // rad, angle of that nut at its seat cue
    double last_yield = -1e9;        // s, last tick in the yield stage

    std::array<PendingCue, vibration_cue_count> pending{};
    VibrationPulse load_pulse{};  // in this tick; amplitude 0: none

    double sent_at = -1e9;                             // s, time of the last command
    double busy_until = -1e9;                          // s, end of the event that the controller renders
    VibrationCue rendered = VibrationCue::load_pulse;  // cue of the last command
};

// Adds a tick. A tick with a value that is not finite only advances the time and ends the load pulse. A nut
// that jumps, because a step was undone, gives no cue. `dt`: s.
void advance_vibration(VibrationState& state, const VibrationOptions& options, const VibrationInput& input,
                       double dt);

// The command to send in this frame, which replaces the command that the controller renders. The pending
// event with the highest rank comes first; the others wait, at most max_wait. An event never interrupts one
// of higher rank. Returns nullopt if there is nothing to send.
std::optional<VibrationCommand> next_vibration(VibrationState& state, const VibrationOptions& options);

}  // namespace bolt::servo
