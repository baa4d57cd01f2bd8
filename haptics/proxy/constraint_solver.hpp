// Finds the motion of a rigid body that is nearest to a wanted motion, among those that contacts with Coulomb
// friction permit. A twist represents a motion. This constrained least-squares problem is the small dense
// problem inside the god-object.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "engine/base/math.hpp"
#include "haptics/collision/solid.hpp"

namespace bolt::proxy {

// A small motion in the surroundings' frame: translation of the body's origin and rotation about it.
struct Twist {
    Vec3 linear{0.0};   // m
    Vec3 angular{0.0};  // rad
};

inline Twist operator*(double scale, const Twist& twist) {
    return {scale * twist.linear, scale * twist.angular};
}

// The pose after the twist. The origin moves on a straight line, the rotation is about a fixed direction at a
// constant rate, so half of the twist gives half of the motion.
inline Pose moved(const Pose& pose, const Twist& twist) {
    return {pose.position + twist.linear, glm::normalize(rotation(twist.angular) * pose.orientation)};
}

// The twist from one pose to the other; its rotation is at most half a turn.
inline Twist twist_between(const Pose& from, const Pose& to) {
    return {to.position - from.position, turn_between(from.orientation, to.orientation)};
}

// Upper bound (m) of the distance that any point within `radius` of the origin travels during `twist`.
inline double travel(const Twist& twist, double radius) {
    return glm::length(twist.linear) + radius * glm::length(twist.angular);
}

// The same for points that also lie in `box` (in the body's frame), which is a tighter bound for a long tool.
// The linear part of a point's motion is greatest at a corner of the box; the arc deviates from it by at most
// half the square of the turn times the radius.
inline double travel(const Twist& twist, double radius, const Quat& orientation,
                     const collision::BoundingBox& box) {
    const Quat back = glm::conjugate(orientation);
    const Vec3 linear = back * twist.linear, angular = back * twist.angular;
    double longest = 0.0;
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 corner(i & 1U ? box.high.x : box.low.x, i & 2U ? box.high.y : box.low.y,
                          i & 4U ? box.high.z : box.low.z);
        const Vec3 displacement = linear + glm::cross(angular, corner);
        longest = std::max(longest, glm::dot(displacement, displacement));
    }
    return std::min(travel(twist, radius), std::sqrt(longest) + 0.5 * radius * glm::dot(angular, angular));
}

// Greatest number of constraints in one call; any more are ignored.
inline constexpr std::size_t max_constraints = 48;

// The point at `arm` may move towards the obstacle by at most `slack`. If `slack` is negative, the point must
// move away by at least −slack.
struct Constraint {
    Vec3 arm{0.0};                      // m, from the body's origin
    Vec3 normal{0.0};                   // unit, away from the obstacle
    double slack = 0.0;                 // m
    double friction_coefficient = 0.0;  // ≥ 0
};

// Weights of a deviation from the wanted motion. They equal the stiffness of the coupling, so that the
// contact forces equal the force that the coupling renders.
struct Metric {
    double linear = 1000.0;  // N/m
    double angular = 10.0;   // N·m/rad
};

struct ConstrainedMotion {
    Twist motion;
    // m, of the worst constraint; above a micrometre only if constraints contradict each other.
    double violation = 0.0;
    int factorisations = 0;  // 6×6 systems solved
};

// Returns the motion u nearest to `wanted` (Gauss's principle of least constraint; for the god-object:
// Ortega, Redon and Coquillart, IEEE TVCG 13(3), 2007): metric · (u − wanted) is the sum of the contact
// forces, each in its friction cone. A contact with slack left has no force; friction opposes the slip of a
// sliding contact; a contact inside its cone does not slip. Redundant, degenerate and contradicting
// constraints are allowed. Without friction the result is unique and continuous in all inputs. Bounded work,
// no allocation; the same inputs give the same bits. `forces`, if not empty, receives the force of each
// contact on the body, N. A good `initial_guess` of the result saves work.
ConstrainedMotion constrain(const Metric& metric, const Twist& wanted,
                            std::span<const Constraint> constraints, std::span<Vec3> forces = {},
                            const std::optional<Twist>& initial_guess = {});

}  // namespace bolt::proxy
