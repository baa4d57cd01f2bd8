#include "haptics/contact/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace bolt::contact {
namespace {

Status add_shape(World& world, std::span<const ContactMesh> parts, std::vector<std::int32_t> ids,
                 const WorldOptions& options) {
    Result<Solid> solid = make_solid(parts);
    if (!solid) return fail(solid.error());
    world.shapes.push_back({std::move(*solid), {}, {}, std::move(ids)});
    Shape& shape = world.shapes.back();
    shape.vicinity = make_vicinity(shape.solid, options.cell);
    // Closer than the tool's: at 1.5 mm a fillet of the wrench got 0.14 mm deep onto a ridge (bolt-truth).
    shape.samples = make_samples(shape.solid, {.edges = false, .round = true, .along_edges = 1.1e-3});
    return {};
}

}  // namespace

Result<World> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options) {
    World world;
    std::vector<ContactMesh> still;
    std::vector<std::int32_t> ids;
    for (const Obstacle& o : obstacles) {
        if (o.mesh == nullptr || o.mesh->triangles.empty())
            return fail(ErrorCode::bad_content, fmt::format("obstacle {} has no contact mesh", o.id));
        if (o.moves) continue;
        still.push_back(moved(*o.mesh, o.pose));
        ids.push_back(o.id);
    }
    if (!still.empty()) {
        if (const Status added = add_shape(world, still, std::move(ids), options); !added)
            return fail(added.error());
        world.bodies.push_back({-1, 0, {}, true});
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

std::optional<std::size_t> find_body(const World& world, std::int32_t id) {
    for (std::size_t i = 0; i < world.bodies.size(); ++i)
        if (world.bodies[i].id == id && world.shapes[world.bodies[i].shape].part_ids.empty()) return i;
    return std::nullopt;
}

std::int32_t obstacle_of(const World& world, const Body& body, std::uint32_t triangle) {
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
    double distance = nothing_near;
    for (const Body& body : world.bodies) {
        if (!body.on) continue;
        distance = std::min(distance, near_point(world.shapes[body.shape].solid, inverse(body.pose) * point,
                                                 nothing_near, 0.0, {})
                                          .distance);
    }
    return distance;
}

}  // namespace bolt::contact
