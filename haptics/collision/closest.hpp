// Closest points of points, triangles and segments (C. Ericson, Real-Time Collision Detection, 2005, 5.1),
// and Embree point queries with a margin for its single precision.
#pragma once

#include <algorithm>
#include <array>
#include <cfloat>
#include <cstdint>
#include <glm/geometric.hpp>

#include "engine/base/embree.hpp"
#include "engine/base/math.hpp"

namespace bolt::collision {

// 0…2: a vertex; 3…5: the edge from vertex 0, 1, 2 to the next; 6: the inside of the face.
using Region = std::uint8_t;

struct ClosestTrianglePoint {
    Vec3 point{0.0};
    Region region = 6;
};

inline ClosestTrianglePoint closest_on_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
    const Vec3& a = t[0];
    const Vec3& b = t[1];
    const Vec3& c = t[2];
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const Vec3 ap = p - a;
    const double d1 = glm::dot(ab, ap);
    const double d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return {a, 0};
    const Vec3 bp = p - b;
    const double d3 = glm::dot(ab, bp);
    const double d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return {b, 1};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {a + ab * (d1 / (d1 - d3)), 3};
    const Vec3 cp = p - c;
    const double d5 = glm::dot(ab, cp);
    const double d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return {c, 2};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {a + ac * (d2 / (d2 - d6)), 5};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
        return {b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 4};
    const double scale = 1.0 / (va + vb + vc);
    return {a + ab * (vb * scale) + ac * (vc * scale), 6};
}

// Parameters, −1 … 1, of the closest points of two segments middle ± half. `inner`: neither point is at an
// end and the segments are not parallel.
struct ClosestSegmentParameters {
    double s = 0.0, t = 0.0;
    bool inner = false;
};

inline ClosestSegmentParameters closest_on_segments(const Vec3& middle_a, const Vec3& half_a,
                                                    const Vec3& middle_b, const Vec3& half_b) {
    const double aa = glm::dot(half_a, half_a);
    const double bb = glm::dot(half_b, half_b);
    const double ab = glm::dot(half_a, half_b);
    const double determinant = aa * bb - ab * ab;  // aa * bb * sin^2 of the angle between them
    const Vec3 between = middle_b - middle_a;
    const double a = glm::dot(half_a, between);
    const double b = glm::dot(half_b, between);
    const bool crossed = determinant > 1e-6 * aa * bb;
    const double s = crossed ? (a * bb - b * ab) / determinant : 0.0;
    const double t = crossed ? (a * ab - b * aa) / determinant : 2.0;
    if (std::abs(s) <= 1.0 && std::abs(t) <= 1.0) return {s, t, true};
    // Clamp one parameter, take the closest point on the other segment, and vice versa.
    double on_a = std::clamp(s, -1.0, 1.0);
    const double on_b = std::clamp((ab * on_a - b) / bb, -1.0, 1.0);
    on_a = std::clamp((ab * on_b + a) / aa, -1.0, 1.0);
    return {on_a, on_b, false};
}

// m; surfaces that are at most this far apart count as coincident.
inline constexpr double coincidence_tolerance = 1e-7;

// The radius in float with a margin, so that a query finds everything that is within `radius` in double.
inline float with_margin(double radius, const Vec3& p) {
    if (!(radius < 1e30)) return FLT_MAX;
    const double size = std::abs(p.x) + std::abs(p.y) + std::abs(p.z) + radius;
    return static_cast<float>(radius + 1e-6 * size + 2.0 * coincidence_tolerance);
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
