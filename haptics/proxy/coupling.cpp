#include "haptics/proxy/coupling.hpp"

#include <algorithm>
#include <limits>

namespace bolt::proxy {

namespace {

constexpr double margin = 0.8;           // of what passivity allows
constexpr double collision_speed = 0.5;  // m/s
constexpr double millisecond = 1e-3;     // s
constexpr double step_share = 0.1;       // of the greatest force, in a millisecond

// Smooth saturation: linear for small x, tends to the length `most` for large x. If x has half that length,
// the result is 1.5 % shorter than x.
Vec3 saturated(const Vec3& x, double most) {
    if (most <= 0.0) return Vec3(0.0);
    const double ratio = glm::dot(x, x) / square(most);
    // Beyond this 1 + ratio² equals ratio² in double, and the square could overflow.
    if (ratio > 1e8) return x * (most / glm::length(x));
    return x / std::sqrt(std::sqrt(1.0 + square(ratio)));
}

struct Spring {
    double stiffness = 0.0;
    double damping = 0.0;
};

// The stiffest spring with K dt / 2 ≤ margin b, and a damper with half of the damping that remains.
Spring passive(double greatest, double physical, double dt) {
    Spring spring;
    spring.stiffness = std::min(greatest, margin * 2.0 * physical / dt);
    spring.damping = 0.5 * std::max(0.0, margin * physical - 0.5 * spring.stiffness * dt);
    return spring;
}

}  // namespace

Coupling make_coupling(const CouplingRange& range) {
    Coupling coupling;
    // N·s/m: permitted increase of the force per millisecond, divided by the speed; unlimited if no force is
    // rendered.
    const double max_force_per_speed = range.max_force > 0.0 ? step_share * range.max_force / collision_speed
                                                             : std::numeric_limits<double>::infinity();
    const Spring straight =
        passive(std::min(range.stiffness, 0.75 * max_force_per_speed / millisecond), range.damping, range.dt);
    coupling.stiffness = straight.stiffness;
    // The damper responds to a collision at once, so spring and damper together must stay within the limit
    // per millisecond.
    coupling.damping = std::min(straight.damping, max_force_per_speed - straight.stiffness * millisecond);
    const Spring turning = passive(range.torsion, range.torsion_damping, range.dt);
    coupling.torsion = turning.stiffness;
    coupling.torsion_damping = turning.damping;
    coupling.max_force = range.max_force;
    coupling.max_torque = range.max_torque;
    return coupling;
}

Offset offset_between(const Pose& commanded_tool, const Pose& constrained_tool) {
    const Quat turn = constrained_tool.orientation * glm::conjugate(commanded_tool.orientation);
    return {constrained_tool.position - commanded_tool.position, 2.0 * turn.w * Vec3(turn.x, turn.y, turn.z)};
}

force::OutputCommand coupling_force(const Coupling& c, const Offset& offset, const Offset& before,
                                    double dt) {
    const Vec3 force = c.stiffness * offset.linear + (c.damping / dt) * (offset.linear - before.linear);
    const Vec3 torque =
        c.torsion * offset.angular + (c.torsion_damping / dt) * (offset.angular - before.angular);
    return {saturated(force, c.max_force), saturated(torque, c.max_torque)};
}

double stored_energy(const Coupling& c, const Offset& offset) {
    // A spring whose stiffness nowhere exceeds K stores at least F²/2K. For rotation, where the torque
    // follows the sine, this bound is K sin²/2, which is less than the exact K (1 − cos).
    const auto stored = [](const Vec3& force, double stiffness) {
        return stiffness > 0.0 ? 0.5 * glm::dot(force, force) / stiffness : 0.0;
    };
    return stored(saturated(c.stiffness * offset.linear, c.max_force), c.stiffness) +
           stored(saturated(c.torsion * offset.angular, c.max_torque), c.torsion);
}

}  // namespace bolt::proxy
