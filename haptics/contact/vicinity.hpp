// A solid's surroundings, told apart once at load: an octree, fine near the surface where that is not flat.
// Every leaf knows how far its middle is from the surface, and lists the triangles that a point in it may
// have to be compared with. That sets aside what is far, and answers exactly what is near.
#pragma once

#include <optional>

#include "haptics/contact/solid.hpp"

namespace bolt::contact {

// A leaf lists all triangles that may be within this of any point in it (m).
inline constexpr double vicinity_reach = 0.7e-3;

inline constexpr int vicinity_levels = 5;  // below the root cells

// Where more would be listed, none are.
inline constexpr std::size_t most_listed = 256;

// A leaf that lists triangles.
struct Place {
    std::uint32_t begin = 0, end = 0;  // of `Vicinity::triangles`
    // Of `Vicinity::boxes`: for as many boxes as there are triangles, rounded up to fours, the lowest x, …,
    // the highest z.
    std::uint32_t boxes = 0;
    // All triangles lie behind this plane, none of their normals is further from its than `spread` (rad).
    Vec3 normal{0.0};
    double height = 0.0;
    float spread = 0.0F;
    // What is before the plane is outside of the solid.
    bool front = false;
    // The triangles belong to one part, and nowhere within reach does one rise above another's plane: a point
    // outside has one side.
    bool convex = false;
};

struct Vicinity {
    struct Node {
        float distance;     // m, signed, at the middle
        std::int32_t next;  // > 0: the first of eight nodes; < 0: a place; 0: no surface is within reach
    };
    Vec3 low{0.0};                                    // m, of the first root cell
    double root = 0.0;                                // m, the size of a root cell
    double per_root = 0.0;                            // 1 / root
    std::array<double, vicinity_levels + 1> sizes{};  // m, of cells by level
    double rounding = 0.0;       // m: more than what points and distances in float are off by
    std::array<int, 3> roots{};  // along each axis; 0: nothing is known
    std::vector<Node> nodes;     // root cells first, x fastest
    std::vector<Place> places;   // the first is none
    std::vector<std::uint32_t> triangles;
    std::vector<float> boxes;
};

// Cells as small as `cell` (m), and as far around the solid's box as a root cell reaches.
Vicinity make_vicinity(const Solid& solid, double cell);

// Of a point: `lower` <= signed distance, |signed distance| <= `upper`. Beyond the octree nothing is told.
struct Look {
    double lower = -nothing_near, upper = nothing_near;
    // Null: nothing is listed.
    const Place* place = nullptr;
    // No surface is nearer than that without being listed: at least `vicinity_reach`.
    double unlisted = 0.0;
};
Look look(const Vicinity& vicinity, const Vec3& point);

// The leaf that was looked at last: of points near each other many are in one.
struct Leaf {
    Vec3 middle{0.0};  // m, from `Vicinity::low`
    double half = -1.0;
    const Vicinity::Node* node = nullptr;
};
Look look(const Vicinity& vicinity, const Vec3& point, Leaf& last);

// As `near_point` where the nearest surface is listed; nothing where it is not, so that it is further than
// `Look::unlisted`. `band` <= reach.
std::optional<Near> near_listed(const Solid& solid, const Vicinity& vicinity, const Look& seen,
                                const Vec3& point, double band, std::span<Side> sides);

}  // namespace bolt::contact
