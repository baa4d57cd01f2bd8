// Point queries of Embree, which looks in float: what is within a radius in double is surely found.
#pragma once

#include <embree3/rtcore.h>

#include <cfloat>

#include "engine/base/math.hpp"

namespace bolt::collision {

// Surfaces that are no further apart are in one place (m).
inline constexpr double one_place = 1e-7;

inline float with_margin(double radius, const Vec3& p) {
    if (!(radius < 1e30)) return FLT_MAX;
    const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + radius;
    return static_cast<float>(radius + 1e-6 * size + 2.0 * one_place);
}

inline RTCPointQuery make_query(const Vec3& p, double radius) {
    RTCPointQuery query{};
    query.x = static_cast<float>(p.x);
    query.y = static_cast<float>(p.y);
    query.z = static_cast<float>(p.z);
    query.radius = with_margin(radius, p);
    return query;
}

}  // namespace bolt::collision
