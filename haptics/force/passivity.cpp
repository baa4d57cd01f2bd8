#include "haptics/force/passivity.hpp"

#include <algorithm>

namespace bolt::force {

namespace {

// The share of the requested wrench that the device can render, common to force and torque: it preserves the
// line of action of a contact force. Separate clamps would produce a field that is not conservative, in which
// a hand gains energy on a closed path. A component that the device does not render at all is ignored.
double renderable_share(const OutputLimits& limits, const OutputCommand& request) {
    const double force = glm::length(request.force), torque = glm::length(request.torque);
    double share = 1.0;
    if (limits.force > 0.0 && force > limits.force) share = limits.force / force;
    if (limits.torque > 0.0 && torque > limits.torque) share = std::min(share, limits.torque / torque);
    return share;
}

}  // namespace

void observe(const OutputLimits& limits, PassivityState& s, const Motion& motion, double ticks) {
    const OutputCommand& out = s.sent[static_cast<std::size_t>(std::clamp(limits.delay, 0, 3))];
    s.applied.force += ticks * out.force;
    s.applied.torque += ticks * out.torque;
    s.ticks += ticks;
    if (!motion.fresh && !motion.begins) return;
    if (motion.fresh)
        s.balance -=
            (glm::dot(s.applied.force, motion.shift) + glm::dot(s.applied.torque, motion.turn)) / s.ticks;
    s.applied = {};
    s.ticks = 0.0;
}

OutputCommand control(const OutputLimits& limits, PassivityState& s, const Motion& motion,
                      const ForceRequest& request, double strength, double before, double dt) {
    // A spring clamped to a share r of its force takes the same work at first but returns only that force: 2
    // r − r² of its energy can be recovered.
    const double r = renderable_share(limits, request.command);
    const double full = request.stored_energy * r * (2.0 - r);
    const double stored = strength * full;
    // Energy that enters with the ramp is not work of the hand and counts as injected.
    const double injected = strength * request.injected_energy + (strength - before) * full;
    s.balance = std::min(s.balance + injected - (stored - s.stored_energy), saved_at_most);
    if (s.balance > 0.0) s.balance *= std::max(0.0, 1.0 - dt / saved_for);
    s.stored_energy = stored;

    const double b = damping_share * limits.damping, b_angular = damping_share * limits.angular_damping;
    const double power = b * glm::dot(motion.velocity, motion.velocity) +
                         b_angular * glm::dot(motion.angular_velocity, motion.angular_velocity);
    const double needed = std::max(0.0, -s.balance) / dt;
    const double target = needed < power ? needed / power : needed > 0.0 ? 1.0 : 0.0;
    s.damping += std::clamp(target - s.damping, -damping_goes * dt, damping_comes * dt);
    s.removed += s.damping * power * dt;
    // Damping is subtracted after the clamp; subtracted from a force far above the limit it would have no
    // effect.
    return {r * request.command.force - s.damping * b * motion.velocity,
            r * request.command.torque - s.damping * b_angular * motion.angular_velocity};
}

void note_sent(PassivityState& s, const OutputCommand& sent) {
    for (std::size_t i = s.sent.size() - 1; i > 0; --i) s.sent[i] = s.sent[i - 1];
    s.sent[0] = sent;
}

}  // namespace bolt::force
