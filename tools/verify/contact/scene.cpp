#include "tools/verify/contact/scene.hpp"

#include <algorithm>

namespace bolt::contact_validation {

using namespace contact_oracle;

namespace {

// Splits a solid into the parts from which it was joined.
std::vector<collision::ContactMesh> parts_of(const collision::Solid& solid) {
    std::vector<collision::ContactMesh> parts;
    for (std::size_t t = 0; t < solid.mesh.triangles.size(); ++t) {
        const std::size_t part = solid.part.empty() ? 0 : solid.part[t];
        if (part >= parts.size()) parts.resize(part + 1);
        if (parts[part].vertices.empty()) parts[part].vertices = solid.mesh.vertices;
        parts[part].triangles.push_back(solid.mesh.triangles[t]);
    }
    return parts;
}

// Returns the sample points of a shape as degenerate triangles. Contact queries must return their exact
// distance.
geometry::Bvh points_of(const collision::SurfaceSamples& samples) {
    std::vector<geometry::Triangle> points;
    for (const collision::SurfaceSample& sample : samples.samples)
        if (sample.piece == collision::SurfaceSample::no_piece)
            points.push_back({sample.at, sample.at, sample.at, 0});
    return geometry::Bvh(std::move(points));
}

// Restricts the search to depths above `known` (m).
DepthOptions deeper_than(DepthOptions depths, double known) {
    depths.min_depth = std::max(depths.min_depth, known);
    return depths;
}

}  // namespace

ClosedSurface surface_of(const collision::ContactMesh& mesh) {
    std::vector<geometry::Triangle> triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = collision::corners(mesh, t);
        triangles.push_back({a, b, c, static_cast<std::uint32_t>(t)});
    }
    return contact_oracle::make_surface(std::move(triangles));
}

ContactScene make_scene(const collision::CollisionWorld& world, const collision::ToolShape& tool) {
    ContactScene scene;
    scene.tool = surface_of(tool.solid.mesh);
    scene.tool_points = points_of(tool.samples);
    for (std::size_t b = 0; b < world.bodies.size(); ++b) {
        const collision::CollisionShape& shape = world.shapes[world.bodies[b].shape];
        const std::vector<collision::ContactMesh> parts = parts_of(shape.solid);
        for (std::size_t i = 0; i < parts.size(); ++i)
            scene.parts.push_back(
                {surface_of(parts[i]), b, shape.part_ids.empty() ? world.bodies[b].id : shape.part_ids[i]});
        scene.points.push_back(points_of(shape.samples));
    }
    return scene;
}

ExactContact exact_contact(const ContactScene& scene, std::size_t part, const Pose& to_part,
                           const OracleQuery& query) {
    const ClosedSurface& surface = scene.parts[part].surface;
    ExactContact exact;
    exact.crosses = cross(surface.tree, scene.tool.tree, to_part);
    if (!exact.crosses) {
        exact.gap = gap(surface.tree, scene.tool.tree, to_part, query.reach);
        return exact;
    }
    exact.depth = depth_in(scene.tool.tree, surface, to_part, query.depths);
    exact.depth = std::max(exact.depth, depth_in(surface.tree, scene.tool, inverse(to_part),
                                                 deeper_than(query.depths, exact.depth)));
    return exact;
}

ExactContact exact_contact(const ContactScene& scene, const collision::CollisionWorld& world,
                           const Pose& tool, const OracleQuery& query) {
    ExactContact all{false, query.reach, 0.0, 0};
    OracleQuery remaining = query;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const ExactContact exact =
            exact_contact(scene, i, inverse(world.bodies[scene.parts[i].body].pose) * tool, remaining);
        if (exact.depth > all.depth) all.depth = exact.depth, all.deepest = i;
        if (!exact.crosses && exact.gap < all.gap) all.gap = exact.gap;
        all.crosses = all.crosses || exact.crosses;
        remaining.depths = deeper_than(remaining.depths, all.depth);
        remaining.reach = all.gap;
    }
    if (all.crosses) all.gap = 0.0;
    return all;
}

ExactContact exact_contact_of_points(const ContactScene& scene, const collision::CollisionWorld& world,
                                     const Pose& tool, bool crosses, const OracleQuery& query) {
    ExactContact all{crosses, query.reach, 0.0, 0};
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const ObstaclePart& part = scene.parts[i];
        const Pose to_part = inverse(world.bodies[part.body].pose) * tool;
        const bool first =
            i == 0 || scene.parts[i - 1].body != part.body;  // all parts of a body share its points
        if (!crosses) {
            all.gap = gap(part.surface.tree, scene.tool_points, to_part, all.gap);
            if (first) all.gap = gap(scene.points[part.body], scene.tool.tree, to_part, all.gap);
            continue;
        }
        const auto deeper = [&](double depth) { all.depth = std::max(all.depth, depth); };
        deeper(depth_in(scene.tool_points, part.surface, to_part, deeper_than(query.depths, all.depth)));
        if (first)
            deeper(depth_in(scene.points[part.body], scene.tool, inverse(to_part),
                            deeper_than(query.depths, all.depth)));
    }
    return all;
}

}  // namespace bolt::contact_validation
