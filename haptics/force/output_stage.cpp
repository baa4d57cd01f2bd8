#include "haptics/force/output_stage.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

constexpr double watchdog_smoothing_time = 0.005;  // s, of the velocity that the speed limits check
// s, of the velocity that damping uses; unfiltered encoder steps would be felt as noise.
constexpr double damping_smoothing_time = 0.0015;

bool is_pose(const DeviceInput& input) {
    const Pose& p = input.pose;
    // False for NaN too. No device moves a kilometre.
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(p.position[i]) < 1e3)) return false;
    return input.valid && std::abs(glm::dot(p.orientation, p.orientation) - 1.0) < 1e-2;
}

// Updates the motion from the sample. Returns false if it is farther from the last one than a hand can move.
bool update_motion(const OutputLimits& limits, WatchdogState& s, const Pose& pose, double dt) {
    const auto ticks = static_cast<double>(s.ticks_since_sample);
    Motion& m = s.motion;
    m.shift = pose.position - s.last.position;
    m.rotation = turn_between(s.last.orientation, pose.orientation);
    s.last = pose;
    if (glm::length(m.shift) > limits.jump * ticks || glm::length(m.rotation) > limits.angular_jump * ticks) {
        m = {};
        return false;
    }
    const double elapsed = ticks * dt;
    const Vec3 velocity = m.shift / elapsed, angular_velocity = m.rotation / elapsed;
    const double smooth = 1.0 - std::exp(-elapsed / damping_smoothing_time);
    m.velocity += smooth * (velocity - m.velocity);
    m.angular_velocity += smooth * (angular_velocity - m.angular_velocity);
    const double share = 1.0 - std::exp(-elapsed / watchdog_smoothing_time);
    s.mean_velocity += share * (velocity - s.mean_velocity);
    s.mean_angular_velocity += share * (angular_velocity - s.mean_angular_velocity);
    m.fresh = true;
    return true;
}

Fault check_sample(const OutputLimits& limits, WatchdogState& s, const DeviceInput& input,
                   bool request_is_finite, double dt) {
    s.ticks_since_sample += 1 + input.missed;
    s.motion.fresh = s.motion.first = false;
    if (input.fresh) {
        if (!is_pose(input)) {
            s.has_last = false;  // the next pose starts a new motion
            s.motion = {};
            s.ticks_since_sample = 0;
            return Fault::no_pose;
        }
        if (s.has_last && !update_motion(limits, s, input.pose, dt)) {
            s.ticks_since_sample = 0;
            return Fault::jumped;
        }
        s.motion.first = !s.has_last;
        s.last = input.pose;
        s.has_last = true;
        s.ticks_since_sample = 0;
    } else if (static_cast<double>(s.ticks_since_sample) * dt > limits.max_silence) {
        s.motion = {};
        return Fault::silent;
    }
    // Hysteresis: after a fault the speed must fall below half the limit.
    const double share = s.fault == Fault::too_fast ? 0.5 : 1.0;
    if (glm::length(s.mean_velocity) > share * limits.speed ||
        glm::length(s.mean_angular_velocity) > share * limits.angular_speed)
        return Fault::too_fast;
    return request_is_finite ? Fault::none : Fault::bad_request;
}

}  // namespace

const char* message_for(Fault fault) {
    switch (fault) {
        case Fault::none:
            return "none";
        case Fault::silent:
            return "the device is silent";
        case Fault::no_pose:
            return "the device's sample is not a pose";
        case Fault::jumped:
            return "the device's pose jumped";
        case Fault::too_fast:
            return "the device moves too fast";
        case Fault::bad_request:
            return "the requested force is not finite";
        case Fault::stopped:
            return "emergency stop";
    }
    return "";
}

bool update_watchdog(const OutputLimits& limits, WatchdogState& s, const DeviceInput& input,
                     bool request_is_finite, double dt) {
    const Fault before = s.fault;
    const Fault now = check_sample(limits, s, input, request_is_finite, dt);
    // ISO 13850: the stop overrides everything, lasts until a deliberate reset, and the reset starts nothing
    // by itself.
    if (input.stop || (before == Fault::stopped && !(input.reset && !input.dead_man))) {
        s.fault = Fault::stopped;
        s.ticks_without_fault = 0;
    } else if (now != Fault::none) {
        s.fault = now;
        s.ticks_without_fault = 0;
    } else if (before == Fault::stopped) {
        s.fault = Fault::none;
    } else if (before != Fault::none &&
               static_cast<double>(++s.ticks_without_fault) * dt >= limits.recovery_time * (1 - 1e-9)) {
        s.fault = Fault::none;
    }
    if (s.fault != before && s.fault != Fault::none) ++s.counts[static_cast<std::size_t>(s.fault)];
    return s.fault == Fault::none;
}

namespace {

// The share of the requested force and torque that the device can render. Both are scaled by the same share,
// which preserves the line of action of a contact force. Separate clamps would produce a field that is not
// conservative, in which a hand gains energy on a closed path. A component that the device does not render at
// all is ignored.
double renderable_share(const OutputLimits& limits, const OutputCommand& request) {
    const double force = glm::length(request.force), torque = glm::length(request.torque);
    double share = 1.0;
    if (limits.force > 0.0 && force > limits.force) share = limits.force / force;
    if (limits.torque > 0.0 && torque > limits.torque) share = std::min(share, limits.torque / torque);
    return share;
}

}  // namespace

void add_applied_work(const OutputLimits& limits, PassivityState& s, const Motion& motion, double ticks) {
    const OutputCommand& out = s.sent[static_cast<std::size_t>(std::clamp(limits.delay, 0, 3))];
    s.applied.force += ticks * out.force;
    s.applied.torque += ticks * out.torque;
    s.ticks += ticks;
    if (!motion.fresh && !motion.first) return;
    if (motion.fresh)
        s.balance -=
            (glm::dot(s.applied.force, motion.shift) + glm::dot(s.applied.torque, motion.rotation)) / s.ticks;
    s.applied = {};
    s.ticks = 0.0;
}

OutputCommand control_passivity(const OutputLimits& limits, PassivityState& s, const Motion& motion,
                                const ForceRequest& request, double ramp, double ramp_before, double dt) {
    // The device renders the share r of a spring's force. While the spring relaxes, the rendered force is
    // constant until the spring's own force falls below the clamp: 2r − r² of the energy is returned.
    const double r = renderable_share(limits, request.command);
    const double full = request.stored_energy * r * (2.0 - r);
    const double stored = ramp * full;
    // Energy that enters with the ramp is not work of the hand and counts as injected.
    const double injected = ramp * request.injected_energy + (ramp - ramp_before) * full;
    s.balance = std::min(s.balance + injected - (stored - s.stored_energy), max_credit);
    if (s.balance > 0.0) s.balance *= std::max(0.0, 1.0 - dt / credit_decay_time);
    s.stored_energy = stored;

    const double b = damping_share * limits.damping, b_angular = damping_share * limits.angular_damping;
    const double power = b * glm::dot(motion.velocity, motion.velocity) +
                         b_angular * glm::dot(motion.angular_velocity, motion.angular_velocity);
    const double needed = std::max(0.0, -s.balance) / dt;
    const double target = needed < power ? needed / power : needed > 0.0 ? 1.0 : 0.0;
    s.damping += std::clamp(target - s.damping, -damping_fall_rate * dt, damping_rise_rate * dt);
    s.removed += s.damping * power * dt;
    // Damping is subtracted after the clamp; subtracted from a force far above the limit it would have no
    // effect.
    return {r * request.command.force - s.damping * b * motion.velocity,
            r * request.command.torque - s.damping * b_angular * motion.angular_velocity};
}

void record_sent(PassivityState& s, const OutputCommand& sent) {
    for (std::size_t i = s.sent.size() - 1; i > 0; --i) s.sent[i] = s.sent[i - 1];
    s.sent[0] = sent;
}

namespace {

Vec3 step_towards(const Vec3& now, const Vec3& target, double max_step) {
    return now + clamp_length(target - now, max_step);
}

}  // namespace

OutputCommand limit_output(const OutputLimits& limits, LimiterState& state, const OutputCommand& requested,
                           bool enabled, double dt, double release) {
    const bool healthy = finite(state.force) && finite(state.torque);
    if (!healthy) state.force = state.torque = Vec3(0.0);
    const bool valid_request = healthy && finite(requested.force) && finite(requested.torque);
    if (!valid_request) ++state.invalid_requests;
    if (!enabled || !valid_request) {
        // Reaches zero from the largest output in whole steps within `release`; overrides the slew rates.
        const double steps = std::max(1.0, std::floor(release / dt + 1e-9));
        const double share = (1.0 + 1e-9) / steps;
        state.ramp = 0.0;
        state.force = step_towards(state.force, Vec3(0.0), limits.force * share);
        state.torque = step_towards(state.torque, Vec3(0.0), limits.torque * share);
    } else {
        state.ramp = std::min(1.0, state.ramp + dt / limits.ramp_up);
        const Vec3 force = clamp_length(requested.force, limits.force) * state.ramp;
        const Vec3 torque = clamp_length(requested.torque, limits.torque) * state.ramp;
        state.force = step_towards(state.force, force, limits.force_slew_rate * dt);
        state.torque = step_towards(state.torque, torque, limits.torque_slew_rate * dt);
    }
    // Final clamp: it bounds the effect of any error above.
    state.force = clamp_length(state.force, limits.force);
    state.torque = clamp_length(state.torque, limits.torque);
    if (!finite(state.force) || !finite(state.torque)) {
        state = {Vec3(0.0), Vec3(0.0), 0.0, state.invalid_requests + 1};
    }
    return {state.force, state.torque};
}

OutputCommand render(const OutputLimits& limits, OutputStage& stage, const DeviceInput& input,
                     const ForceRequest& request, double dt) {
    const bool finite_command = finite(request.command.force) && finite(request.command.torque);
    const bool valid_request =
        finite_command && std::isfinite(request.stored_energy) && std::isfinite(request.injected_energy);
    const bool permitted =
        update_watchdog(limits, stage.watchdog, input, valid_request, dt) && input.dead_man;
    const Motion& motion = stage.watchdog.motion;
    PassivityState& passivity = stage.passivity;
    add_applied_work(limits, passivity, motion, 1.0 + input.missed);

    OutputCommand command;
    if (permitted) {
        const double ramp_before = stage.limiter.ramp;
        const double ramp = std::min(1.0, ramp_before + dt / limits.ramp_up);
        command = control_passivity(limits, passivity, motion, request, ramp, ramp_before, dt);
    } else {
        passivity.balance = passivity.stored_energy = passivity.damping = 0.0;
        // `invalid_requests` grows by one for a request with a value that is not finite. limit_output()
        // counts it if the value is in the command, and sends no force then. Here it is counted if only an
        // energy is not finite.
        if (!finite_command)
            command = request.command;
        else if (!valid_request)
            ++stage.limiter.invalid_requests;
    }
    // The release time counts from the last sample, and part of it has already passed.
    const bool silent = stage.watchdog.fault == Fault::silent;
    const double release = silent ? limits.release - limits.max_silence - dt : limits.release;
    const OutputCommand sent = limit_output(limits, stage.limiter, command, permitted, dt, release);
    record_sent(passivity, sent);
    return sent;
}

}  // namespace bolt::force
