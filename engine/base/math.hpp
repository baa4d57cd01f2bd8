// Vectors, quaternions and angles. SI units: metres, radians, newtons. Right-handed frames, Y up in world
// space.
#pragma once

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <numbers>

namespace bolt {

using Vec3 = glm::dvec3;
using Quat = glm::dquat;

inline constexpr double pi = std::numbers::pi;

constexpr double to_radians(double degrees) { return degrees * (pi / 180.0); }
constexpr double to_degrees(double radians) { return radians * (180.0 / pi); }

constexpr double square(double x) { return x * x; }

// Returns the angle reduced to [-period/2, period/2].
inline double wrap(double angle, double period) { return std::remainder(angle, period); }

}  // namespace bolt
