#include "haptics/collision/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::collision {
namespace {

constexpr double off_surface = 50e-6;  // m, where a line of sight ends: more than float is off by

// The additive recurrence with the plastic number (Roberts, 2018): even in two dimensions at any count.
constexpr double plastic = 1.3247179572447460;
double fraction(double x) { return x - std::floor(x); }

Visibility visibility(const World& world, std::optional<std::size_t> body, const Solid& solid,
                      const Pose& pose, std::span<const SurfacePoint> points, const Vec3& eye) {
    const Vec3 eye_there = inverse(pose) * eye;
    double alone = 0.0, seen = 0.0;
    for (const SurfacePoint& spot : points) {
        const Vec3 at = spot.at + off_surface * spot.normal;
        const Vec3 to_eye = eye_there - at;
        const double distance2 = glm::dot(to_eye, to_eye);
        const double facing = glm::dot(spot.normal, to_eye);
        if (facing <= 0.0 || blocked(solid, eye_there, at)) continue;
        const double size = spot.area * facing / (distance2 * std::sqrt(distance2));
        alone += size;
        if (!occluded(world, eye, pose * at, body)) seen += size;
    }
    return {alone > 0.0 ? seen / alone : 0.0, seen};
}

}  // namespace

std::vector<SurfacePoint> sample_surface(const ContactMesh& mesh, std::size_t count) {
    std::vector<double> sums;
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners(mesh, t);
        sums.push_back(area += 0.5 * glm::length(glm::cross(b - a, c - a)));
    }
    std::vector<SurfacePoint> points;
    if (sums.empty()) return points;
    for (std::size_t i = 0; i < count; ++i) {
        const double step = static_cast<double>(i) + 0.5;
        const auto above =
            std::upper_bound(sums.begin(), sums.end(), step / static_cast<double>(count) * area);
        const auto t = std::min(mesh.triangles.size() - 1, static_cast<std::size_t>(above - sums.begin()));
        const auto [a, b, c] = corners(mesh, t);
        const double u = std::sqrt(fraction(step / plastic)), v = fraction(step / (plastic * plastic));
        points.push_back({a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v), Vec3(mesh.face_normals[t]),
                          area / static_cast<double>(count)});
    }
    return points;
}

std::vector<SurfacePoint> sample_outer_surface(const Solid& solid, std::size_t count) {
    std::vector<SurfacePoint> points = sample_surface(solid.mesh, count);
    std::erase_if(points, [&](const SurfacePoint& spot) {
        return blocked(solid, spot.at + 2.0 * off_surface * spot.normal,
                       spot.at + 2.0 * solid.radius * spot.normal);
    });
    return points;
}

Visibility visibility_of(const World& world, std::size_t body, std::span<const SurfacePoint> points,
                         const Vec3& eye) {
    const Body& own = world.bodies[body];
    return visibility(world, body, world.shapes[own.shape].solid, own.pose, points, eye);
}

Visibility visibility_of(const World& world, const Solid& solid, const Pose& pose,
                         std::span<const SurfacePoint> points, const Vec3& eye) {
    return visibility(world, std::nullopt, solid, pose, points, eye);
}

}  // namespace bolt::collision
