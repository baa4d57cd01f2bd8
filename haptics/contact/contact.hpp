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
    std::uint32_t feature =
        0;  // which feature of the tool (or, top bit set, of the obstacle): stays the same while both move
};

struct Found {
    std::size_t count = 0;  // contacts written
    double clearance =
        0.0;  // m: beyond the contacts written nothing is nearer than this; a lower bound that holds
    bool crowded = false;  // there were more contacts than room; the nearest were kept, and `clearance` says
                           // what holds for the rest
};

}  // namespace bolt::contact
