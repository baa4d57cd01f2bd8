// The search for a free path by which a tool can leave a joint. In reverse, the path brings the tool onto the
// joint.
#pragma once

#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/free_swing.hpp"
#include "tools/author/geometry/obstacles.hpp"

namespace bolt::geometry {

// The paths by which an open end can leave the nut: up along the bolt, or sideways out of the jaw.
struct ExitPaths {
    double height = 0.0;     // m, of the tool's origin above the joint's, while the tool is on the joint
    double jaw_angle = 0.0;  // rad about +Y, from the handle to the jaw
    double head_size = 0.0;  // m, from the middle of the jaw to the outside of the head
    double reach = 0.0;      // m, largest distance of the tool from the axis
};

// Returns no_part if at least one path is free, otherwise a part that blocks a path.
std::uint32_t find_obstruction(const Obstacles& surroundings, const Bvh& tool, const FreeSwing& swing,
                               const ExitPaths& paths);

// The path by which a ring, a socket or a key leaves: `lift` along the bolt, then up or to any side.
struct AxialExit {
    double height = 0.0;  // m, of the tool's origin above the joint's, while the tool is on the joint
    double lift = 0.0;    // m by which the tool has to rise to clear the turned part and the bolt's end
    double reach = 0.0;   // m, largest distance of the tool from the axis
};

// Returns no_part if the path is free at some angle of the swing, otherwise a part that blocks it.
std::uint32_t find_obstruction(const Obstacles& surroundings, const Bvh& tool, const FreeSwing& swing,
                               const AxialExit& exit);

}  // namespace bolt::geometry
