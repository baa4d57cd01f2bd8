#include "haptics/force/limiter.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Vec3 step_towards(const Vec3& now, const Vec3& target, double most) {
    return now + clamp_length(target - now, most);
}

}  // namespace

OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& requested,
                           bool enabled, double dt, double release) {
    const bool healthy = finite(state.force) && finite(state.torque);
    if (!healthy) state.force = state.torque = Vec3(0.0);
    const bool sound = healthy && finite(requested.force) && finite(requested.torque);
    if (!sound) ++state.faults;
    if (!enabled || !sound) {
        // Reaches zero from the largest output in whole steps within `release`; overrides the slew limits.
        const double steps = std::max(1.0, std::floor(release / dt + 1e-9));
        const double share = (1.0 + 1e-9) / steps;
        state.strength = 0.0;
        state.force = step_towards(state.force, Vec3(0.0), limits.force * share);
        state.torque = step_towards(state.torque, Vec3(0.0), limits.torque * share);
    } else {
        state.strength = std::min(1.0, state.strength + dt / limits.ramp_up);
        const Vec3 force = clamp_length(requested.force, limits.force) * state.strength;
        const Vec3 torque = clamp_length(requested.torque, limits.torque) * state.strength;
        state.force = step_towards(state.force, force, limits.force_rate * dt);
        state.torque = step_towards(state.torque, torque, limits.torque_rate * dt);
    }
    // Final clamp: it bounds the effect of any error above.
    state.force = clamp_length(state.force, limits.force);
    state.torque = clamp_length(state.torque, limits.torque);
    if (!finite(state.force) || !finite(state.torque)) {
        state = {Vec3(0.0), Vec3(0.0), 0.0, state.faults + 1};
    }
    return {state.force, state.torque};
}

}  // namespace bolt::force
