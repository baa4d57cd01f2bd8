// The world that the tool collides with, and the tool's own shape. Fixed obstacles are joined into one solid;
// bodies that move keep frames of their own. Both are built at load; poses and switches may change between
// ticks, which does not allocate.
#pragma once

#include <optional>

#include "haptics/collision/contact.hpp"
#include "haptics/collision/samples.hpp"
#include "haptics/collision/triangle_octree.hpp"

namespace bolt::collision {

struct ToolOptions {
    SampleOptions samples{.on_faces = 500};
    double cell = 0.75e-3;  // m, cell size of the octree; 0: no octree
};

// The tool in its own frame.
struct ToolShape {
    Solid solid;
    TriangleOctree octree;
    Samples samples;
    [[nodiscard]] double reach() const { return solid.reach; }  // m, greatest distance from the tool's origin
};

// Fails if a part is not closed, since the inside of the tool must be defined, or if the options are invalid.
Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options = {});

struct Obstacle {
    ObstacleId id;                      // copied to its contacts
    const ContactMesh* mesh = nullptr;  // may be shared; must live until make_world returns
    Pose pose;                          // to the assembly
    bool moves = false;                 // also set for what may be switched off or overlaps other obstacles
};

struct WorldOptions {
    double cell = 3e-3;  // m, cell size of the octrees; 0: no octrees
};

// A solid of the world and the samples of it that are tested against the tool.
struct Shape {
    Solid solid;
    TriangleOctree octree;
    Samples samples;
    std::vector<ObstacleId> part_ids;  // of the fixed obstacles; empty for the shape of a moving body
};

struct Body {
    ObstacleId id;
    std::size_t shape = 0;
    Pose pose;  // to the assembly
    bool on = true;
};

struct World {
    std::vector<Shape> shapes;
    std::vector<Body> bodies;  // the first is the union of the fixed obstacles, if there are any
};

// Fails if an obstacle has no mesh or its mesh has no triangles.
Result<World> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options = {});

// The index in `bodies` of the moving body with this id.
std::optional<std::size_t> find_body(const World& world, ObstacleId id);

// The obstacle that a triangle of a body's mesh belongs to.
ObstacleId obstacle_of(const World& world, const Body& body, std::uint32_t triangle);

// True if a body that is on intersects the segment between two points. `ignored`: index of a body to skip.
bool occluded(const World& world, const Vec3& from, const Vec3& to,
              std::optional<std::size_t> ignored = std::nullopt);

// m, from a point to the nearest body that is on; infinite without one.
double signed_distance(const World& world, const Vec3& point);

}  // namespace bolt::collision
