// The pose of a nut's model on its joint: the direction of its hexagon and the height of its bearing face.
#pragma once

#include <span>

#include "haptics/servo/setup.hpp"

namespace bolt::session {

struct HexagonLie {
    Quat straighten{1.0, 0.0, 0.0, 0.0};  // about the bolt; puts a corner on e1
    double low = 0.0;                     // m, bearing face along the bolt, from the seat
};

// Finds the six corners as the outermost points of the mesh. `points`: in the assembly's frame.
HexagonLie lie_of(const servo::NutGeometry& nut, std::span<const glm::dvec3> points);

// From the assembly's frame to the nut's own; servo::nut_pose maps back to where the nut is.
inline Vec3 to_own_frame(const servo::NutGeometry& nut, const HexagonLie& lie, const Vec3& p) {
    const Vec3 d = p - nut.seat;
    const Vec3 local(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
    return lie.straighten * (local - Vec3(0, 0, lie.low));
}

}  // namespace bolt::session
