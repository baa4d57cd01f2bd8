#include "haptics/proxy/coupling.hpp"

#include <algorithm>
#include <limits>

namespace bolt::proxy {

namespace {

constexpr double margin = 0.8;         // of what passivity allows
constexpr double hardest_speed = 0.5;  // m/s
constexpr double millisecond = 1e-3;   // s
constexpr double step_share = 0.1;     // of the greatest force, in a millisecond

// Linear for small x, towards `most` for large ones; at half of it 1.5 % less than linear.
Vec3 saturated(const Vec3& x, double most) {
    if (most <= 0.0) return Vec3(0.0);
    const double ratio = glm::dot(x, x) / square(most);
    // Beyond that 1 + ratio² is ratio² to the last bit, and could overflow.
    if (ratio > 1e8) return x * (most / glm::length(x));
    return x / std::sqrt(std::sqrt(1.0 + square(ratio)));
}

struct Spring {
    double stiffness = 0.0;
    double damping = 0.0;
};

// Half of what passivity leaves goes to the damper: K dt / 2 + B ≤ margin b with K at its greatest, B = 0.
Spring passive(double greatest, double physical, double dt) {
    Spring spring;
    spring.stiffness = std::min(greatest, margin * 2.0 * physical / dt);
    spring.damping = 0.5 * std::max(0.0, margin * physical - 0.5 * spring.stiffness * dt);
    return spring;
}

}  // namespace

Coupling make_coupling(const CouplingRange& range) {
    Coupling coupling;
    // N·s/m: force a millisecond and speed. Where none is rendered nothing hits hard.
    const double hardest = range.force > 0.0 ? step_share * range.force / hardest_speed
                                             : std::numeric_limits<double>::infinity();
    const Spring straight =
        passive(std::min(range.stiffness, 0.75 * hardest / millisecond), range.damping, range.dt);
    coupling.stiffness = straight.stiffness;
    // The damper answers a collision at once: both together stay within what a millisecond may bring.
    coupling.damping = std::min(straight.damping, hardest - straight.stiffness * millisecond);
    const Spring turning = passive(range.torsion, range.torsion_damping, range.dt);
    coupling.torsion = turning.stiffness;
    coupling.torsion_damping = turning.damping;
    coupling.force = range.force;
    coupling.torque = range.torque;
    return coupling;
}

Offset offset_between(const Pose& device, const Pose& tool) {
    const Quat turn = tool.orientation * glm::conjugate(device.orientation);
    return {tool.position - device.position, 2.0 * turn.w * Vec3(turn.x, turn.y, turn.z)};
}

force::OutputCommand coupling_force(const Coupling& c, const Offset& offset, const Offset& before,
                                    double dt) {
    const Vec3 force = c.stiffness * offset.linear + (c.damping / dt) * (offset.linear - before.linear);
    const Vec3 torque =
        c.torsion * offset.angular + (c.torsion_damping / dt) * (offset.angular - before.angular);
    return {saturated(force, c.force), saturated(torque, c.torque)};
}

double stored_energy(const Coupling& c, const Offset& offset) {
    // Of a spring whose stiffness nowhere exceeds K, F²/2K or more is stored. For the turn, whose torque goes
    // with the sine, that is K sin²/2, and K (1 - cos) is more.
    const auto held = [](const Vec3& force, double stiffness) {
        return stiffness > 0.0 ? 0.5 * glm::dot(force, force) / stiffness : 0.0;
    };
    return held(saturated(c.stiffness * offset.linear, c.force), c.stiffness) +
           held(saturated(c.torsion * offset.angular, c.torque), c.torsion);
}

}  // namespace bolt::proxy
