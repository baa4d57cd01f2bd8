// Vectors, quaternions, angles, rigid poses, the minimum-jerk profile, and quantiles. SI units: metres,
// radians, newtons. Right-handed frames, Y up in world space.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace bolt {

using Vec3 = glm::dvec3;
using Quat = glm::dquat;

inline constexpr double pi = std::numbers::pi;
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double mm = 1e-3, um = 1e-6;  // m

constexpr double to_radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double to_degrees(double radians) { return radians * (180.0 / pi); }

constexpr double square(double x) { return x * x; }

// Returns true if no component is infinite or NaN.
inline bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Piecewise linear interpolation of y over x at `at`. `x` is strictly ascending; `x` and `y` have the same
// size, at least 2. Outside the range of `x` the result is the first or last value of `y`.
inline double interpolate(std::span<const double> x, std::span<const double> y, double at) {
    const auto after = std::upper_bound(x.begin(), x.end(), at) - x.begin();
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after, 1, std::ssize(x) - 1));
    const double part = std::clamp((at - x[i - 1]) / (x[i] - x[i - 1]), 0.0, 1.0);
    return y[i - 1] + part * (y[i] - y[i - 1]);
}

// Returns the angle reduced to [-period/2, period/2].
inline double wrap(double angle, double period) { return std::remainder(angle, period); }

// The pose of a rigid body: the transform from body coordinates to the surrounding frame. Its operations are
// always inlined, as those of glm are (cmake/house.cmake says why).
struct Pose {
    Vec3 position{0.0};                    // m, the body's origin
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // unit quaternion
};

[[gnu::always_inline]] inline Vec3 operator*(const Pose& pose, const Vec3& point) {
    return pose.position + pose.orientation * point;
}
[[gnu::always_inline]] inline Pose operator*(const Pose& a, const Pose& b) {
    return {a * b.position, a.orientation * b.orientation};
}
[[gnu::always_inline]] inline Pose inverse(const Pose& pose) {
    const Quat conjugate = glm::conjugate(pose.orientation);
    return {conjugate * -pose.position, conjugate};
}

// The angles, rad, from an eye's viewing direction to the edges of its picture; left and down are negative.
struct FieldOfView {
    double left = 0.0, right = 0.0, up = 0.0, down = 0.0;
};

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
// The rotation vector (rad, in the surrounding frame) that turns one orientation to the other; its angle is
// in [0, π].
inline Vec3 turn_between(const Quat& from, const Quat& to) {
    return rotation_vector(glm::normalize(to * glm::conjugate(from)));
}

// The minimum-jerk profile of a reaching hand: 10τ³ − 15τ⁴ + 6τ⁵, at rest at both ends (Flash and Hogan,
// J. Neurosci. 5 (1985) 1688). `tau`: the fraction of the duration that has passed, clamped to 0 … 1. Returns
// the fraction of the distance that the hand has covered.
inline double minimum_jerk(double tau) {
    const double t = std::clamp(tau, 0.0, 1.0);
    return t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

// Returns the value below which the fraction `share` of the values lies; 0 without values.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto last = values.size() - 1;
    const auto at = std::min(last, static_cast<std::size_t>(share * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

}  // namespace bolt
