#include "tools/verify/contact/scene.hpp"

#include <algorithm>

namespace bolt::contact_validation {

using namespace contact_oracle;

namespace {

// The parts that a solid was joined from.
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

// The sample points of a shape, as degenerate triangles: contact queries must know their exact distance.
geometry::Bvh points_of(const collision::Samples& samples) {
    std::vector<geometry::Triangle> points;
    for (const collision::Sample& sample : samples.samples)
        if (sample.piece == collision::Sample::no_piece)
            points.push_back({sample.at, sample.at, sample.at, 0});
    return geometry::Bvh(std::move(points));
}

// Only what is deeper still.
DepthOptions beyond(DepthOptions depths, double known) {
    depths.least = std::max(depths.least, known);
    return depths;
}

}  // namespace

Surface surface_of(const collision::ContactMesh& mesh) {
    std::vector<geometry::Triangle> triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = collision::corners(mesh, t);
        triangles.push_back({a, b, c, static_cast<std::uint32_t>(t)});
    }
    return contact_oracle::make_surface(std::move(triangles));
}

Scene make_scene(const collision::World& world, const collision::ToolShape& tool) {
    Scene scene;
    scene.tool = surface_of(tool.solid.mesh);
    scene.tool_points = points_of(tool.samples);
    for (std::size_t b = 0; b < world.bodies.size(); ++b) {
        const collision::Shape& shape = world.shapes[world.bodies[b].shape];
        const std::vector<collision::ContactMesh> parts = parts_of(shape.solid);
        for (std::size_t i = 0; i < parts.size(); ++i)
            scene.parts.push_back(
                {surface_of(parts[i]), b, shape.part_ids.empty() ? world.bodies[b].id : shape.part_ids[i]});
        scene.points.push_back(points_of(shape.samples));
    }
    return scene;
}

Meeting meet(const Scene& scene, std::size_t part, const Pose& to_part, const Looking& looking) {
    const Surface& surface = scene.parts[part].surface;
    Meeting met;
    met.crosses = cross(surface.tree, scene.tool.tree, to_part);
    if (!met.crosses) {
        met.gap = gap(surface.tree, scene.tool.tree, to_part, looking.reach);
        return met;
    }
    met.depth = depth_in(scene.tool.tree, surface, to_part, looking.depths);
    met.depth = std::max(
        met.depth, depth_in(surface.tree, scene.tool, inverse(to_part), beyond(looking.depths, met.depth)));
    return met;
}

Meeting meet(const Scene& scene, const collision::World& world, const Pose& tool, const Looking& looking) {
    Meeting all{false, looking.reach, 0.0, 0};
    Looking less = looking;
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const Meeting met = meet(scene, i, inverse(world.bodies[scene.parts[i].body].pose) * tool, less);
        if (met.depth > all.depth) all.depth = met.depth, all.deepest = i;
        if (!met.crosses && met.gap < all.gap) all.gap = met.gap;
        all.crosses = all.crosses || met.crosses;
        less.depths = beyond(less.depths, all.depth);
        less.reach = all.gap;
    }
    if (all.crosses) all.gap = 0.0;
    return all;
}

Meeting meet_points(const Scene& scene, const collision::World& world, const Pose& tool, bool crosses,
                    const Looking& looking) {
    Meeting all{crosses, looking.reach, 0.0, 0};
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const Part& part = scene.parts[i];
        const Pose to_part = inverse(world.bodies[part.body].pose) * tool;
        const bool first =
            i == 0 || scene.parts[i - 1].body != part.body;  // the body's points belong to all its parts
        if (!crosses) {
            all.gap = gap(part.surface.tree, scene.tool_points, to_part, all.gap);
            if (first) all.gap = gap(scene.points[part.body], scene.tool.tree, to_part, all.gap);
            continue;
        }
        const auto deeper = [&](double depth) { all.depth = std::max(all.depth, depth); };
        deeper(depth_in(scene.tool_points, part.surface, to_part, beyond(looking.depths, all.depth)));
        if (first)
            deeper(depth_in(scene.points[part.body], scene.tool, inverse(to_part),
                            beyond(looking.depths, all.depth)));
    }
    return all;
}

}  // namespace bolt::contact_validation
