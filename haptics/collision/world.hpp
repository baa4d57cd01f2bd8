// The world that the tool collides with, the tool's own shape, and the visible fraction of a body. Obstacles
// without a body of their own (Obstacle::own_body) are joined into one solid. World and tool are built at
// load; Body::pose and Body::enabled may change between ticks, which does not allocate.
#pragma once

#include <optional>
#include <vector>

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
    SurfaceSamples samples;
    // m, greatest distance from the tool's origin.
    [[nodiscard]] double origin_radius() const { return solid.origin_radius; }
};

// Fails if a part is not closed, since the inside of the tool must be defined, or if the options are invalid.
Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options = {});

struct Obstacle {
    ObstacleId id;                      // copied to its contacts
    const ContactMesh* mesh = nullptr;  // may be shared; must live until make_world returns
    Pose pose;                          // to the assembly
    // It gets a body of its own: necessary if it moves, may be disabled or overlaps others.
    bool own_body = false;
};

struct WorldOptions {
    double cell = 3e-3;  // m, cell size of the octrees; 0: no octrees
};

// A solid of the world and the samples of it that are tested against the tool.
struct CollisionShape {
    Solid solid;
    TriangleOctree octree;
    SurfaceSamples samples;
    // By part of `solid`, if this is the union of obstacles without a body of their own; otherwise empty.
    std::vector<ObstacleId> part_ids;
};

struct Body {
    ObstacleId id;          // none for the union of obstacles without a body of their own
    std::size_t shape = 0;  // index in `CollisionWorld::shapes`
    Pose pose;              // to the assembly
    bool enabled = true;
};

struct CollisionWorld {
    std::vector<CollisionShape> shapes;
    std::vector<Body> bodies;  // the first is the union of obstacles without a body of their own, if any
};

// Fails if an obstacle has no mesh or its mesh has no triangles.
Result<CollisionWorld> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options = {});

// The index in `bodies` of the body with this id. None for an obstacle without a body of its own.
std::optional<std::size_t> find_body(const CollisionWorld& world, ObstacleId id);

// The obstacle that a triangle of a body's mesh belongs to.
ObstacleId obstacle_of(const CollisionWorld& world, const Body& body, std::uint32_t triangle);

// True if an enabled body intersects the segment between two points. `ignored`: index of a body to skip.
bool occluded(const CollisionWorld& world, const Vec3& from, const Vec3& to,
              std::optional<std::size_t> ignored = std::nullopt);

// m, from a point to the nearest enabled body; infinite without one.
double signed_distance(const CollisionWorld& world, const Vec3& point);

// A sample of a surface, in the frame of its body, for the visibility queries below.
struct SurfacePoint {
    Vec3 at{0.0};       // m
    Vec3 normal{0.0};   // unit, outward
    double area = 0.0;  // m² that it represents
};

// Spreads `count` points over a mesh evenly by area. Deterministic.
std::vector<SurfacePoint> sample_surface(const ContactMesh& mesh, std::size_t count);

// Spreads `count` points as sample_surface() does, and drops those that face another surface of the solid,
// such as the points in a bore, which a bolt fills.
std::vector<SurfacePoint> sample_outer_surface(const Solid& solid, std::size_t count);

struct Visibility {
    double share = 0.0;  // 0…1, `angle` divided by the angle without other bodies; 0 if the latter is 0
    double angle = 0.0;  // sr, visible solid angle
};

// Visibility of the body with this index in the world's current state, by rays. `points`: samples of its
// surface. `eye`: m, in the assembly's frame. Used to choose views and to decide what a simulated trainee
// sees. Other bodies that are not enabled hide nothing; the body itself need not be enabled. With n points
// the error of the share is about 1/√n.
Visibility visibility_of(const CollisionWorld& world, std::size_t body, std::span<const SurfacePoint> points,
                         const Vec3& eye);

// The same for a solid that is not part of the world, such as a tool in the hand.
Visibility visibility_of(const CollisionWorld& world, const Solid& solid, const Pose& pose,
                         std::span<const SurfacePoint> points, const Vec3& eye);

}  // namespace bolt::collision
