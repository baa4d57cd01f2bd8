#include "haptics/servo/vibration.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::servo {

namespace {

constexpr double max_nut_speed = 100.0;               // rad/s; faster is a jump
constexpr double rest_motion = to_radians(0.02);      // rad; less is rest
constexpr double rest_time = 0.1;                     // s without motion until a nut is at rest
constexpr double breakaway_motion = to_radians(0.1);  // rad by which a resting nut breaks away
constexpr double yield_pause = 0.3;                   // s without yield until its cue may be given again
constexpr double detent_wait = 0.02;                  // s; a late detent would feel like another one

std::size_t index_of(VibrationCue cue) { return static_cast<std::size_t>(cue); }

bool is_valid(const VibrationInput& input) {
    return std::isfinite(input.torque) && std::isfinite(input.target) && std::isfinite(input.angle) &&
           std::isfinite(input.strike_speed);
}

const VibrationPulse& pulse_of(const VibrationOptions& options, VibrationCue cue) {
    switch (cue) {
        case VibrationCue::detent:
            return options.detent;
        case VibrationCue::strike:
            return options.strike;
        case VibrationCue::breakaway:
            return options.breakaway;
        case VibrationCue::seat:
            return options.seat;
        case VibrationCue::yield:
            return options.yield;
        case VibrationCue::slip:
            return options.slip;
        case VibrationCue::click:
            return options.click;
        case VibrationCue::load_pulse:
            break;
    }
    return options.load_pulse;
}

// `scale`: 0 … 1, of the amplitude. If the same event is pending already, the greater amplitude stays.
void add_event(VibrationState& state, const VibrationOptions& options, VibrationCue cue, double scale = 1.0) {
    VibrationState::PendingCue& pending = state.pending[index_of(cue)];
    const double amplitude = pulse_of(options, cue).amplitude * std::clamp(scale, 0.0, 1.0);
    pending = {std::max(pending.amplitude, amplitude), state.time};
}

// Amplitude at `share` of the target torque, relative to the amplitude at the target torque.
double load_scale(const VibrationOptions& options, double share) {
    return std::pow(std::clamp(share, 0.0, options.max_share), 1.0 / options.sensation_exponent);
}

double share_of(const VibrationInput& input) {
    return input.target > 0.0 ? std::abs(input.torque) / input.target : 0.0;
}

double detent_below(const VibrationOptions& options, double angle) {
    return options.detent_angle * std::floor(angle / options.detent_angle);
}

// Takes the nut as it is, without a cue: it has just been engaged, or has jumped.
void engage(VibrationState& state, const VibrationOptions& options, const VibrationInput& input) {
    state.joint = input.joint;
    state.stage = input.stage;
    state.angle = state.rest_angle = input.angle;
    state.share = share_of(input);
    state.growth = state.speed = 0.0;
    state.last_detent_angle = detent_below(options, input.angle);
    state.rest_since = state.time;
    state.at_rest = false;
}

void add_detents(VibrationState& state, const VibrationOptions& options, const VibrationInput& input) {
    const double turned = input.angle - state.last_detent_angle;
    if (std::abs(turned) < options.detent_angle) return;
    // After a reversal the next detent comes after a whole detent_angle, so that the cue does not repeat at
    // one angle.
    state.last_detent_angle += options.detent_angle * std::trunc(turned / options.detent_angle);
    if (input.stage == joint::Stage::navigation) add_event(state, options, VibrationCue::detent);
}

void add_stage_changes(VibrationState& state, const VibrationOptions& options, const VibrationInput& input) {
    const bool seated = input.stage != joint::Stage::navigation;
    if (seated && state.stage == joint::Stage::navigation && state.seated_joint != input.joint) {
        add_event(state, options, VibrationCue::seat);
        state.seated_joint = input.joint;
        state.seat_angle = input.angle;
    }
    // The seat cue is repeated only after the nut has been turned back by half a detent angle.
    if (!seated && state.seated_joint == input.joint &&
        input.angle < state.seat_angle - 0.5 * options.detent_angle)
        state.seated_joint = -1;
    if (input.stage != joint::Stage::yield) return;
    if (state.stage != joint::Stage::yield && state.time - state.last_yield > yield_pause)
        add_event(state, options, VibrationCue::yield);
    state.last_yield = state.time;
}

void add_breakaway(VibrationState& state, const VibrationOptions& options, const VibrationInput& input) {
    const double moved = std::abs(input.angle - state.rest_angle);
    if (state.at_rest && moved > breakaway_motion) {
        const double share = share_of(input);
        if (input.stage != joint::Stage::navigation && share >= options.min_share)
            add_event(state, options, VibrationCue::breakaway, load_scale(options, share));
        state.at_rest = false;
    }
    if (state.at_rest) return;
    if (moved > rest_motion) {
        state.rest_angle = input.angle;
        state.rest_since = state.time;
    }
    state.at_rest = state.time - state.rest_since >= rest_time;
}

// Sets the load pulse.
void update_load_pulse(VibrationState& state, const VibrationOptions& options, const VibrationInput& input,
                       double dt) {
    const double share = share_of(input);
    const double weight = dt / (options.smoothing_time + dt);
    state.growth += weight * ((share - state.share) / dt - state.growth);
    state.speed += weight * (std::abs(input.angle - state.angle) / dt - state.speed);
    state.share = share;
    state.load_pulse = {};
    const bool loaded = input.stage != joint::Stage::navigation && share > 0.0;
    const bool active = state.growth >= options.min_growth ||
                        (state.speed >= options.min_speed && state.growth > -options.release_rate);
    if (!loaded || !active) return;
    state.load_pulse = options.load_pulse;
    state.load_pulse.amplitude *= load_scale(options, share);
    if (input.stage == joint::Stage::yield) state.load_pulse.frequency = options.yield_frequency;
}

// The event with the highest rank that waits; drops those that have waited too long. None: the load pulse.
VibrationCue strongest(VibrationState& state, const VibrationOptions& options) {
    VibrationCue found = VibrationCue::load_pulse;
    for (std::size_t i = index_of(VibrationCue::detent); i < vibration_cue_count; ++i) {
        VibrationState::PendingCue& pending = state.pending[i];
        const auto cue = static_cast<VibrationCue>(i);
        const double wait = cue == VibrationCue::detent ? detent_wait : options.max_wait;
        if (state.time - pending.time > wait) pending = {};
        if (pending.amplitude > 0.0) found = cue;
    }
    return found;
}

// None if the command is too weak to feel.
std::optional<VibrationCommand> make_command(VibrationState& state, const VibrationOptions& options,
                                             const VibrationPulse& pulse, VibrationCue cue) {
    const double amplitude = std::clamp(options.gain * pulse.amplitude, 0.0, 1.0);
    if (!(amplitude >= options.min_amplitude)) return std::nullopt;
    state.sent_at = state.time;
    state.busy_until = cue == VibrationCue::load_pulse ? state.time : state.time + pulse.duration;
    state.rendered = cue;
    return VibrationCommand{amplitude, pulse.frequency, pulse.duration, cue};
}

}  // namespace

VibrationInput vibration_input(const Output& output, double target, double strike_speed) {
    return {output.joint,     output.stage,        output.wrench_torque, target,
            output.nut_angle, output.slipped >= 0, output.clicked,       strike_speed};
}

void advance_vibration(VibrationState& state, const VibrationOptions& options, const VibrationInput& input,
                       double dt) {
    if (!(dt > 0.0) || !std::isfinite(dt)) return;
    state.time += dt;
    if (!is_valid(input)) {
        state.load_pulse = {};
        return;
    }
    if (input.clicked) add_event(state, options, VibrationCue::click);
    if (input.slipped) add_event(state, options, VibrationCue::slip);
    if (input.strike_speed > 0.0)
        add_event(state, options, VibrationCue::strike, input.strike_speed / options.full_strike);
    if (input.joint < 0) {
        state.joint = -1;
        state.load_pulse = {};
        return;
    }
    if (input.joint != state.joint || std::abs(input.angle - state.angle) > max_nut_speed * dt)
        engage(state, options, input);
    add_detents(state, options, input);
    add_stage_changes(state, options, input);
    add_breakaway(state, options, input);
    update_load_pulse(state, options, input, dt);
    state.angle = input.angle;
    state.stage = input.stage;
}

std::optional<VibrationCommand> next_vibration(VibrationState& state, const VibrationOptions& options) {
    if (!(options.gain > 0.0)) {
        state.pending = {};
        return std::nullopt;
    }
    const VibrationCue cue = strongest(state, options);
    const bool busy = state.time < state.busy_until;
    if (state.time - state.sent_at < options.min_interval || (busy && cue < state.rendered))
        return std::nullopt;
    if (cue == VibrationCue::load_pulse) {
        if (busy || state.load_pulse.amplitude == 0.0) return std::nullopt;
        return make_command(state, options, state.load_pulse, cue);
    }
    VibrationPulse pulse = pulse_of(options, cue);
    VibrationState::PendingCue& pending = state.pending[index_of(cue)];
    pulse.amplitude = pending.amplitude;
    pending = {};
    return make_command(state, options, pulse, cue);
}

}  // namespace bolt::servo
