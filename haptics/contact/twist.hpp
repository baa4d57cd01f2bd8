// A small motion of a body, and poses moved by it.
#pragma once

#include "engine/base/pose.hpp"

namespace bolt::contact {

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

// No point within `radius` of the origin travels farther than this while `twist` is carried out.
inline double travel(const Twist& twist, double radius) {
    return glm::length(twist.linear) + radius * glm::length(twist.angular);
}

}  // namespace bolt::contact
