// The pose of a rigid body: the transform from body coordinates to its surroundings.
#pragma once

#include "engine/base/math.hpp"

namespace bolt {

struct Pose {
    Vec3 position{0.0};                    // m, the body's origin
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // unit quaternion
};

inline Vec3 operator*(const Pose& pose, const Vec3& point) {
    return pose.position + pose.orientation * point;
}
inline Pose operator*(const Pose& a, const Pose& b) {
    return {a * b.position, a.orientation * b.orientation};
}
inline Pose inverse(const Pose& pose) {
    const Quat conjugate = glm::conjugate(pose.orientation);
    return {conjugate * -pose.position, conjugate};
}

// The exponential map of a rotation vector (axis times angle, rad), and its inverse with the angle in [0, π].
inline Quat rotation(const Vec3& vector) {
    const double angle = glm::length(vector);
    const double half = angle < 1e-8 ? 0.5 - angle * angle / 48.0 : std::sin(0.5 * angle) / angle;
    return glm::normalize(Quat(std::cos(0.5 * angle), vector * half));
}
inline Vec3 rotation_vector(const Quat& unit) {
    const Quat q = unit.w < 0.0 ? -unit : unit;
    const Vec3 v(q.x, q.y, q.z);
    const double s = glm::length(v);
    return v * (s < 1e-8 ? 2.0 / q.w : 2.0 * std::atan2(s, q.w) / s);
}

}  // namespace bolt
