// Whether a wrench that fits on a nut can be brought there: lifted off along the bolt, or drawn off sideways.
#pragma once

#include "tools/author/geometry/swing.hpp"

namespace bolt::geometry {

struct Approach {
    double height = 0.0;     // of the wrench on the nut, above the joint's origin
    double jaw_angle = 0.0;  // of the jaw to the handle, rad about +Y
    double head_size = 0.0;  // m
    double reach = 0.0;      // m, of the wrench
};

// What is in the way of every path from every free angle; no_part: there is a path.
std::uint32_t blocked_by(const Bvh& surroundings, const Bvh& wrench, const Swing& swing,
                         const Approach& approach);

}  // namespace bolt::geometry
