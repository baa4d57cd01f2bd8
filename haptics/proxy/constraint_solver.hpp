// A small motion of a body, and poses moved by it.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "engine/base/math.hpp"

namespace bolt::proxy {

// In the surroundings' frame: how the body's origin moves, and how the body turns about it.
struct Twist {
    Vec3 linear{0.0};   // m
    Vec3 angular{0.0};  // rad
};

inline Twist operator*(double scale, const Twist& twist) {
    return {scale * twist.linear, scale * twist.angular};
}

// Straight for the origin, at a constant rate about a fixed direction: half of the twist leads half the way.
inline Pose moved(const Pose& pose, const Twist& twist) {
    return {pose.position + twist.linear, glm::normalize(rotation(twist.angular) * pose.orientation)};
}

// The twist that leads from one pose to the other, by the shorter way round.
inline Twist twist_between(const Pose& from, const Pose& to) {
    return {to.position - from.position,
            rotation_vector(glm::normalize(to.orientation * glm::conjugate(from.orientation)))};
}

// A box, in the body's frame.
struct Extent {
    Vec3 low{0.0}, high{0.0};  // m
};

// No point within `radius` of the origin travels farther than this while `twist` is carried out.
inline double travel(const Twist& twist, double radius) {
    return glm::length(twist.linear) + radius * glm::length(twist.angular);
}

// The same of the points that lie in a box as well: a long tool hardly ever
// turns and goes so that both add up. What a point of it goes in a straight line is greatest at a corner; the
// arc is off that by no more than half the square of the turn.
inline double travel(const Twist& twist, double radius, const Quat& orientation, const Extent& box) {
    const Quat back = glm::conjugate(orientation);
    const Vec3 linear = back * twist.linear, angular = back * twist.angular;
    double longest = 0.0;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 corner(i & 1U ? box.high.x : box.low.x, i & 2U ? box.high.y : box.low.y,
                          i & 4U ? box.high.z : box.low.z);
        const Vec3 way = linear + glm::cross(angular, corner);
        longest = std::max(longest, glm::dot(way, way));
    }
    return std::min(travel(twist, radius), std::sqrt(longest) + 0.5 * radius * glm::dot(angular, angular));
}

// The small dense problem inside the god-object: of all small motions that the contacts allow, the one
// nearest to the motion that is wanted (Gauss's principle of least constraint; for the god-object: Ortega,
// Redon and Coquillart, IEEE TVCG 13(3), 2007), with Coulomb's friction at each contact.

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
