#include "haptics/force/limiter.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

Vec3 towards(const Vec3& now, const Vec3& wanted, double most) { return now + at_most(wanted - now, most); }

}  // namespace

OutputCommand limit_output(const OutputLimits& limits, OutputState& state, const OutputCommand& wanted,
                           bool enabled, double dt, double release) {
    const bool healthy = finite(state.force) && finite(state.torque);
    if (!healthy) state.force = state.torque = Vec3(0.0);
    const bool sound = healthy && finite(wanted.force) && finite(wanted.torque);
    if (!sound) ++state.faults;
    if (!enabled || !sound) {
        // Down from the greatest output in whole steps within `release`, whatever the slew limits say.
        const double steps = std::max(1.0, std::floor(release / dt + 1e-9));
        const double share = (1.0 + 1e-9) / steps;
        state.strength = 0.0;
        state.force = towards(state.force, Vec3(0.0), limits.force * share);
        state.torque = towards(state.torque, Vec3(0.0), limits.torque * share);
    } else {
        state.strength = std::min(1.0, state.strength + dt / limits.ramp_up);
        const Vec3 force = at_most(wanted.force, limits.force) * state.strength;
        const Vec3 torque = at_most(wanted.torque, limits.torque) * state.strength;
        state.force = towards(state.force, force, limits.force_rate * dt);
        state.torque = towards(state.torque, torque, limits.torque_rate * dt);
    }
    // Last of all, so that nothing above can be wrong enough to matter.
    state.force = at_most(state.force, limits.force);
    state.torque = at_most(state.torque, limits.torque);
    if (!finite(state.force) || !finite(state.torque)) {
        state = {Vec3(0.0), Vec3(0.0), 0.0, state.faults + 1};
    }
    return {state.force, state.torque};
}

}  // namespace bolt::force
