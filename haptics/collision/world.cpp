#include "haptics/collision/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace bolt::collision {
namespace {

Status add_shape(World& world, std::span<const ContactMesh> parts, std::vector<ObstacleId> ids,
                 const WorldOptions& options) {
    Result<Solid> solid = make_solid(parts);
    if (!solid) return fail(solid.error());
    world.shapes.push_back({std::move(*solid), {}, {}, std::move(ids)});
    Shape& shape = world.shapes.back();
    shape.octree = make_triangle_octree(shape.solid, options.cell);
    // Closer than the tool's: at 1.5 mm a fillet of the wrench got 0.14 mm deep onto a ridge
    // (bolt-contact-validation).
    shape.samples = make_samples(shape.solid, {.edges = false, .round = true, .along_edges = 1.1e-3});
    return {};
}

}  // namespace

Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options) {
    if (!(options.samples.longest_piece > 0.0) || options.samples.on_faces > 1'000'000)
        return fail(ErrorCode::bad_content,
                    "a tool's edge pieces need a length, and a million points on its faces are enough");
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

Result<World> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options) {
    World world;
    std::vector<ContactMesh> still;
    std::vector<ObstacleId> ids;
    for (const Obstacle& o : obstacles) {
        if (o.mesh == nullptr || o.mesh->triangles.empty())
            return fail(ErrorCode::bad_content,
                        fmt::format("{} {} has no contact mesh; expected a mesh with triangles",
                                    o.id.is_nut() ? "nut" : "fixed obstacle", o.id.index()));
        if (o.moves) continue;
        still.push_back(moved(*o.mesh, o.pose));
        ids.push_back(o.id);
    }
    if (!still.empty()) {
        if (const Status added = add_shape(world, still, std::move(ids), options); !added)
            return fail(added.error());
        world.bodies.push_back({{}, 0, {}, true});
    }
    std::map<const ContactMesh*, std::size_t> shapes;  // looked up only: the order of addresses shows nowhere
    for (const Obstacle& o : obstacles) {
        if (!o.moves) continue;
        const auto [at, is_new] = shapes.try_emplace(o.mesh, world.shapes.size());
        if (is_new)
            if (const Status added = add_shape(world, {o.mesh, 1}, {}, options); !added)
                return fail(added.error());
        world.bodies.push_back({o.id, at->second, o.pose, true});
    }
    return world;
}

std::optional<std::size_t> find_body(const World& world, ObstacleId id) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i)
        if (world.bodies[i].id == id && world.shapes[world.bodies[i].shape].part_ids.empty()) return i;
    return std::nullopt;
}

ObstacleId obstacle_of(const World& world, const Body& body, std::uint32_t triangle) {
    const Shape& shape = world.shapes[body.shape];
    return shape.part_ids.empty() ? body.id : shape.part_ids[shape.solid.part[triangle]];
}

bool occluded(const World& world, const Vec3& from, const Vec3& to, std::optional<std::size_t> ignored) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (!body.on || i == ignored) continue;
        const Pose back = inverse(body.pose);
        if (blocked(world.shapes[body.shape].solid, back * from, back * to)) return true;
    }
    return false;
}

double signed_distance(const World& world, const Vec3& point) {
    double distance = infinite_distance;
    for (const Body& body : world.bodies) {
        if (!body.on) continue;
        distance = std::min(distance, query_point(world.shapes[body.shape].solid, inverse(body.pose) * point,
                                                  infinite_distance, 0.0, {})
                                          .distance);
    }
    return distance;
}

}  // namespace bolt::collision
