#include "haptics/force/passivity.hpp"

#include <algorithm>

namespace bolt::force {

namespace {

// The share of the wanted wrench that the device can give. One for force and torque: a contact that is felt
// at a lever keeps its place. Clamped each for itself they would be the wrench of no contact, and a hand that
// goes round such a field gains or loses energy. What a device renders none of takes nothing from the rest.
double share_of(const OutputLimits& limits, const OutputCommand& wanted) {
    const double force = glm::length(wanted.force), torque = glm::length(wanted.torque);
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
                      const Wanted& wanted, double strength, double before, double dt) {
    // A spring that is clamped to a share r of its force is pressed as far, but gives only that force back:
    // of its energy 2 r - r² is left.
    const double r = share_of(limits, wanted.command);
    const double full = wanted.stored * r * (2.0 - r);
    const double stored = strength * full;
    // What the ramp lets in is no work of the hand either, and is meant to be.
    const double granted = strength * wanted.granted + (strength - before) * full;
    s.balance = std::min(s.balance + granted - (stored - s.stored), saved_at_most);
    if (s.balance > 0.0) s.balance *= std::max(0.0, 1.0 - dt / saved_for);
    s.stored = stored;

    const double b = damping_share * limits.damping, b_angular = damping_share * limits.angular_damping;
    const double power = b * glm::dot(motion.velocity, motion.velocity) +
                         b_angular * glm::dot(motion.angular_velocity, motion.angular_velocity);
    const double needed = std::max(0.0, -s.balance) / dt;
    const double wants = needed < power ? needed / power : needed > 0.0 ? 1.0 : 0.0;
    s.damping += std::clamp(wants - s.damping, -damping_goes * dt, damping_comes * dt);
    s.removed += s.damping * power * dt;
    // Taken off what the device can give: off a force far above that, damping would change nothing.
    return {r * wanted.command.force - s.damping * b * motion.velocity,
            r * wanted.command.torque - s.damping * b_angular * motion.angular_velocity};
}

void note_sent(PassivityState& s, const OutputCommand& sent) {
    for (std::size_t i = s.sent.size() - 1; i > 0; --i) s.sent[i] = s.sent[i - 1];
    s.sent[0] = sent;
}

}  // namespace bolt::force
