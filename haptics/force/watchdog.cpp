#include "haptics/force/watchdog.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

constexpr double speed_smoothing = 0.005;  // s, of the velocity that the speed limits check
constexpr double smoothing =
    0.0015;  // s, of the velocity that damping uses; unfiltered encoder steps would be felt as noise

bool is_pose(const PortInput& input) {
    const Pose& p = input.pose;
    // False for NaN too. No device moves a kilometre.
    for (int i = 0; i < 3; ++i)
        if (!(std::abs(p.position[i]) < 1e3)) return false;
    return input.valid && std::abs(glm::dot(p.orientation, p.orientation) - 1.0) < 1e-2;
}

// Updates the motion from the sample. Returns false if it is farther from the last one than a hand can move.
bool update_motion(const OutputLimits& limits, WatchdogState& s, const Pose& pose, double dt) {
    const auto ticks = static_cast<double>(s.quiet);
    Motion& m = s.motion;
    m.shift = pose.position - s.last.position;
    m.turn = rotation_vector(glm::normalize(pose.orientation * glm::conjugate(s.last.orientation)));
    s.last = pose;
    if (glm::length(m.shift) > limits.jump * ticks || glm::length(m.turn) > limits.angular_jump * ticks) {
        m = {};
        return false;
    }
    const double elapsed = ticks * dt;
    const Vec3 velocity = m.shift / elapsed, angular_velocity = m.turn / elapsed;
    const double smooth = 1.0 - std::exp(-elapsed / smoothing);
    m.velocity += smooth * (velocity - m.velocity);
    m.angular_velocity += smooth * (angular_velocity - m.angular_velocity);
    const double share = 1.0 - std::exp(-elapsed / speed_smoothing);
    s.mean_velocity += share * (velocity - s.mean_velocity);
    s.mean_angular_velocity += share * (angular_velocity - s.mean_angular_velocity);
    m.fresh = true;
    return true;
}

Fault check_sample(const OutputLimits& limits, WatchdogState& s, const PortInput& input,
                   bool request_is_sound, double dt) {
    s.quiet += 1 + input.missed;
    s.motion.fresh = s.motion.begins = false;
    if (input.fresh) {
        if (!is_pose(input)) {
            s.known = false;  // the next pose starts a new motion
            s.motion = {};
            s.quiet = 0;
            return Fault::no_pose;
        }
        if (s.known && !update_motion(limits, s, input.pose, dt)) {
            s.quiet = 0;
            return Fault::jumped;
        }
        s.motion.begins = !s.known;
        s.last = input.pose;
        s.known = true;
        s.quiet = 0;
    } else if (static_cast<double>(s.quiet) * dt > limits.silence) {
        s.motion = {};
        return Fault::silent;
    }
    // Hysteresis: after a fault the speed must fall below half the limit.
    const double share = s.fault == Fault::too_fast ? 0.5 : 1.0;
    if (glm::length(s.mean_velocity) > share * limits.speed ||
        glm::length(s.mean_angular_velocity) > share * limits.angular_speed)
        return Fault::too_fast;
    return request_is_sound ? Fault::none : Fault::bad_request;
}

}  // namespace

const char* name(Fault fault) {
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

bool watch(const OutputLimits& limits, WatchdogState& s, const PortInput& input, bool request_is_sound,
           double dt) {
    const Fault before = s.fault;
    const Fault now = check_sample(limits, s, input, request_is_sound, dt);
    // ISO 13850: the stop overrides everything, lasts until a deliberate reset, and the reset starts nothing
    // by itself.
    if (input.stop || (before == Fault::stopped && !(input.reset && !input.enabled))) {
        s.fault = Fault::stopped;
        s.sound = 0;
    } else if (now != Fault::none) {
        s.fault = now;
        s.sound = 0;
    } else if (before == Fault::stopped) {
        s.fault = Fault::none;
    } else if (before != Fault::none && static_cast<double>(++s.sound) * dt >= limits.recovery * (1 - 1e-9)) {
        s.fault = Fault::none;
    }
    if (s.fault != before && s.fault != Fault::none) ++s.counts[static_cast<std::size_t>(s.fault)];
    return s.fault == Fault::none;
}

}  // namespace bolt::force
