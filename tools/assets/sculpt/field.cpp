#include "tools/assets/sculpt/field.hpp"

#include <algorithm>

namespace bolt::sculpt {

double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b) {
    const Vec3 axis = b - a;
    const Vec3 from_a = p - a;
    const double length2 = glm::dot(axis, axis);
    const double taper = radius_a - radius_b;
    const double side2 = length2 - taper * taper;
    if (side2 <= 0.0) {  // one sphere holds the other
        return taper > 0.0 ? glm::length(from_a) - radius_a : glm::length(p - b) - radius_b;
    }
    const double along = glm::dot(from_a, axis);
    const double beyond = along - length2;
    const Vec3 across = from_a * length2 - axis * along;
    const double across2 = glm::dot(across, across);
    const double along2 = along * along * length2;
    const double beyond2 = beyond * beyond * length2;
    const double k = std::copysign(1.0, taper) * taper * taper * across2;
    if (std::copysign(1.0, beyond) * side2 * beyond2 > k) {
        return std::sqrt(across2 + beyond2) / length2 - radius_b;
    }
    if (std::copysign(1.0, along) * side2 * along2 < k) {
        return std::sqrt(across2 + along2) / length2 - radius_a;
    }
    return (std::sqrt(across2 * side2 / length2) + along * taper) / length2 - radius_a;
}

double ellipsoid(const Vec3& p, const Vec3& radii) {
    const double k0 = glm::length(p / radii);
    const double k1 = glm::length(p / (radii * radii));
    if (k1 < 1e-9) return -std::min({radii.x, radii.y, radii.z});
    return k0 * (k0 - 1.0) / k1;
}

double rounded_box(const Vec3& p, const Vec3& half, double radius) {
    const Vec3 q = glm::abs(p) - half + Vec3(radius);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0) - radius;
}

double smooth_union(double a, double b, double k) {
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - h * h * k * 0.25;
}

double smooth_intersection(double a, double b, double k) { return -smooth_union(-a, -b, k); }

double smooth_difference(double a, double b, double k) { return -smooth_union(-a, b, k); }

double smooth_step(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

Vec3 gradient(const Field& field, const Vec3& p, double h) {
    const Vec3 a(1, -1, -1);
    const Vec3 b(-1, -1, 1);
    const Vec3 c(-1, 1, -1);
    const Vec3 d(1, 1, 1);
    return (a * field(p + a * h) + b * field(p + b * h) + c * field(p + c * h) + d * field(p + d * h)) /
           (4.0 * h);
}

Vec3 project(const Field& field, Vec3 p, double h, int steps) {
    for (int i = 0; i < steps; ++i) {
        const Vec3 g = gradient(field, p, h);
        const double g2 = glm::dot(g, g);
        if (g2 < 1e-6) break;
        p -= g * (field(p) / g2);
    }
    return p;
}

}  // namespace bolt::sculpt
