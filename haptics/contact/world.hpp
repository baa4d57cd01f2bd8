// What a tool can bump into: still obstacles joined into one solid, and bodies that move, each in a frame of
// its own. Made once at load; poses and switches change between ticks, and nothing here allocates then.
#pragma once

#include <optional>

#include "haptics/contact/samples.hpp"
#include "haptics/contact/vicinity.hpp"

namespace bolt::contact {

struct Obstacle {
    std::int32_t id = 0;                // what `Contact::body` will name
    const ContactMesh* mesh = nullptr;  // several obstacles may share one; read while the world is made only
    Pose pose;                          // to the assembly
    bool moves = false;                 // also what may be switched off, and what overlaps another obstacle
};

struct WorldOptions {
    double cell = 3e-3;  // m, of vicinities; 0: there are none
};

// A solid of the world and the samples that are tested against the tool.
struct Shape {
    Solid solid;
    Vicinity vicinity;
    Samples samples;
    std::vector<std::int32_t> part_ids;  // of the still obstacles; empty for a body's shape
};

struct Body {
    std::int32_t id = 0;
    std::size_t shape = 0;
    Pose pose;
    bool on = true;
};

struct World {
    std::vector<Shape> shapes;
    std::vector<Body> bodies;  // the still obstacles are one of them, the first, if there are any
};

Result<World> make_world(std::span<const Obstacle> obstacles, const WorldOptions& options = {});

// The index in `bodies` of the body made of the obstacle that moves and has this id.
std::optional<std::size_t> find_body(const World& world, std::int32_t id);

// The obstacle that a triangle of a body belongs to.
std::int32_t obstacle_of(const World& world, const Body& body, std::uint32_t triangle);

// Whether an obstacle lies between two points; `ignored` is the index of a body that does not count.
bool occluded(const World& world, const Vec3& from, const Vec3& to,
              std::optional<std::size_t> ignored = std::nullopt);

// The signed distance of a point to the nearest obstacle that is on, wherever it is.
double signed_distance(const World& world, const Vec3& point);

}  // namespace bolt::contact
