#include "haptics/collision/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace bolt::collision {
namespace {

Status add_shape(CollisionWorld& world, std::span<const ContactMesh> parts, std::vector<ObstacleId> ids,
                 const WorldOptions& options) {
    Result<Solid> solid = make_solid(parts);
    if (!solid) return fail(solid.error());
    world.shapes.push_back({std::move(*solid), {}, {}, std::move(ids)});
    CollisionShape& shape = world.shapes.back();
    shape.octree = make_triangle_octree(shape.solid, options.cell);
    // Spaced more densely than the tool's: at 1.5 mm a fillet of the wrench penetrated a ridge by 0.14 mm
    // (bolt-contact-validation).
    shape.samples = make_samples(shape.solid, {.edges = false, .round = true, .along_edges = 1.1e-3});
    return {};
}

}  // namespace

Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options) {
    if (!(options.samples.max_piece > 0.0) || options.samples.on_faces > 1'000'000)
        return fail(ErrorCode::bad_content, "the tool's sample options are invalid",
                    "a positive length of edge pieces and at most 1,000,000 points on faces");
    for (const ContactMesh& part : parts)
        if (part.open_edges > 0)
            return fail(ErrorCode::bad_content,
                        fmt::format("the tool's contact mesh is open along {} edges", part.open_edges),
                        "a closed surface");
    BOLT_TRY_ASSIGN(auto solid, make_solid(parts));
    ToolShape tool{std::move(solid), {}, {}};
    tool.octree = make_triangle_octree(tool.solid, options.cell);
    tool.samples = make_samples(tool.solid, options.samples);
    return tool;
}

Result<CollisionWorld> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options) {
    CollisionWorld world;
    std::vector<ContactMesh> fixed;
    std::vector<ObstacleId> ids;
    for (const Obstacle& o : obstacles) {
        if (o.mesh == nullptr || o.mesh->triangles.empty())
            return fail(ErrorCode::bad_content,
                        fmt::format("{} {} has no contact mesh", o.id.is_nut() ? "nut" : "fixed obstacle",
                                    o.id.index()),
                        "a mesh with triangles");
        if (o.own_body) continue;
        fixed.push_back(transformed(*o.mesh, o.pose));
        ids.push_back(o.id);
    }
    if (!fixed.empty()) {
        if (const Status added = add_shape(world, fixed, std::move(ids), options); !added)
            return fail(added.error());
        world.bodies.push_back({{}, 0, {}, true});
    }
    // Used for lookup only, so the order of addresses does not affect the result.
    std::map<const ContactMesh*, std::size_t> shapes;
    for (const Obstacle& o : obstacles) {
        if (!o.own_body) continue;
        const auto [at, is_new] = shapes.try_emplace(o.mesh, world.shapes.size());
        if (is_new)
            if (const Status added = add_shape(world, {o.mesh, 1}, {}, options); !added)
                return fail(added.error());
        world.bodies.push_back({o.id, at->second, o.pose, true});
    }
    return world;
}

std::optional<std::size_t> find_body(const CollisionWorld& world, ObstacleId id) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i)
        if (world.bodies[i].id == id && world.shapes[world.bodies[i].shape].part_ids.empty()) return i;
    return std::nullopt;
}

ObstacleId obstacle_of(const CollisionWorld& world, const Body& body, std::uint32_t triangle) {
    const CollisionShape& shape = world.shapes[body.shape];
    return shape.part_ids.empty() ? body.id : shape.part_ids[shape.solid.part[triangle]];
}

bool occluded(const CollisionWorld& world, const Vec3& from, const Vec3& to,
              std::optional<std::size_t> ignored) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (!body.enabled || i == ignored) continue;
        const Pose back = inverse(body.pose);
        if (occluded(world.shapes[body.shape].solid, back * from, back * to)) return true;
    }
    return false;
}

double signed_distance(const CollisionWorld& world, const Vec3& point) {
    double distance = infinite_distance;
    for (const Body& body : world.bodies) {
        if (!body.enabled) continue;
        distance = std::min(distance, query_point(world.shapes[body.shape].solid, inverse(body.pose) * point,
                                                  infinite_distance, 0.0, {})
                                          .distance);
    }
    return distance;
}

namespace {

// m in front of the surface, where a line of sight ends; exceeds the error in float.
constexpr double off_surface = 50e-6;

// The additive recurrence with the plastic number (Roberts, 2018) is evenly distributed in two dimensions for
// any count.
constexpr double plastic = 1.3247179572447460;
double fraction(double x) { return x - std::floor(x); }

Visibility visibility(const CollisionWorld& world, std::optional<std::size_t> body, const Solid& solid,
                      const Pose& pose, std::span<const SurfacePoint> points, const Vec3& eye) {
    const Vec3 eye_local = inverse(pose) * eye;
    double alone = 0.0, visible = 0.0;
    for (const SurfacePoint& sample : points) {
        const Vec3 at = sample.at + off_surface * sample.normal;
        const Vec3 to_eye = eye_local - at;
        const double distance2 = glm::dot(to_eye, to_eye);
        const double facing = glm::dot(sample.normal, to_eye);
        if (facing <= 0.0 || occluded(solid, eye_local, at)) continue;
        const double size = sample.area * facing / (distance2 * std::sqrt(distance2));
        alone += size;
        if (!occluded(world, eye, pose * at, body)) visible += size;
    }
    return {alone > 0.0 ? visible / alone : 0.0, visible};
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
    std::erase_if(points, [&](const SurfacePoint& sample) {
        return occluded(solid, sample.at + 2.0 * off_surface * sample.normal,
                        sample.at + 2.0 * solid.radius * sample.normal);
    });
    return points;
}

Visibility visibility_of(const CollisionWorld& world, std::size_t body, std::span<const SurfacePoint> points,
                         const Vec3& eye) {
    const Body& own = world.bodies[body];
    return visibility(world, body, world.shapes[own.shape].solid, own.pose, points, eye);
}

Visibility visibility_of(const CollisionWorld& world, const Solid& solid, const Pose& pose,
                         std::span<const SurfacePoint> points, const Vec3& eye) {
    return visibility(world, std::nullopt, solid, pose, points, eye);
}

}  // namespace bolt::collision
