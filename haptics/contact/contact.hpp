// Where the tool is near an obstacle, and who finds that.
#pragma once

#include <cstdint>
#include <span>

#include "engine/base/pose.hpp"

namespace bolt::contact {

// All in the assembly's frame. The closest features: `on_obstacle + distance * normal` is `on_tool` to the
// tolerance that the finder states.
struct Contact {
    Vec3 on_tool{0.0};      // m
    Vec3 on_obstacle{0.0};  // m
    Vec3 normal{0.0};       // unit, from the obstacle towards where the tool may be
    double distance = 0.0;  // m, signed: below 0 the tool is inside
    std::int32_t body = 0;  // which obstacle
    // Which feature of the tool (or, top bit set, of the obstacle): stays the same while both move.
    std::uint32_t feature = 0;
    // Of a mesh that was met: a triangle that the closest point lies on, of whoever the feature is not of.
    std::uint32_t triangle = 0;
    // Unit: the normal, were the facets there the round surface that they stand for (smooth_normals.hpp);
    // zero: no other than `normal`.
    Vec3 smooth{0.0};
};

inline constexpr std::uint32_t of_obstacle = 0x80000000U;  // in `Contact::feature`

struct Found {
    std::size_t count = 0;  // contacts written
    double clearance =
        0.0;  // m: beyond the contacts written nothing is nearer than this; a lower bound that holds
    bool crowded = false;  // there were more contacts than room; the nearest were kept, and `clearance` says
                           // what holds for the rest
    std::uint32_t work = 0;  // about as many samples had to be compared with a surface for it
};

}  // namespace bolt::contact
