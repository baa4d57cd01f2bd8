// The small dense problem inside the god-object: of all small motions that the contacts allow, the one
// nearest to the motion that is wanted (Gauss's principle of least constraint; for the god-object: Ortega,
// Redon and Coquillart, IEEE TVCG 13(3), 2007), with Coulomb's friction at each contact.
#pragma once

#include <optional>
#include <span>

#include "haptics/proxy/twist.hpp"

namespace bolt::proxy {

// Contacts taken in one call; of longer spans the rest is ignored.
inline constexpr std::size_t most_constraints = 48;

// The point at `arm` may move towards the obstacle by at most `slack`; below 0 it must move away.
struct Constraint {
    Vec3 arm{0.0};          // m, from the body's origin
    Vec3 normal{0.0};       // unit, away from the obstacle
    double slack = 0.0;     // m
    double friction = 0.0;  // coefficient, ≥ 0
};

// What a deviation from the wanted motion costs: the stiffness of the coupling, so that the force which the
// contacts bear is the force which the coupling renders.
struct Metric {
    double linear = 1000.0;  // N/m
    double angular = 10.0;   // N·m/rad
};

struct ConstrainedMotion {
    Twist motion;
    double violation = 0.0;  // m, of the worst constraint; above a micrometre only where they contradict
    int factorisations = 0;  // 6×6 systems solved
};

// The motion u nearest to `wanted`: metric · (u − wanted) = sum of contact forces, each in its friction cone;
// no force where the slack is not spent; a contact that slips is pushed against its slip, one that bears
// without reaching the cone stays where it is. Redundant, degenerate and contradicting constraints are
// allowed; the answer is unique without friction and continuous in all numbers given. A fixed bound of work,
// no allocation, the same bits for the same numbers. `forces`, where given, gets what each contact bears, N.
// `expected` is about what it will come to, if somebody knows: the nearer, the less work.
ConstrainedMotion constrain(const Metric& metric, const Twist& wanted,
                            std::span<const Constraint> constraints, std::span<Vec3> forces = {},
                            const std::optional<Twist>& expected = {});

}  // namespace bolt::proxy
