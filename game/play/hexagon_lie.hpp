// How a nut's model lies on its joint: which way its hexagon points, and where its bearing face is.
#pragma once

#include <span>

#include "haptics/servo/setup.hpp"

namespace bolt::play {

struct HexagonLie {
    Quat straighten{1.0, 0.0, 0.0, 0.0};  // about the bolt: a corner comes to lie along e1
    double low = 0.0;                     // m, of the bearing face, along the bolt from the seat
};

// Read off the mesh, `points` in the assembly's frame: corners are what is furthest out, six times around.
HexagonLie lie_of(const servo::NutPlace& nut, std::span<const glm::dvec3> points);

// From the assembly's frame to the nut's own (servo::nut_pose takes it back to wherever the nut is).
inline Vec3 to_own_frame(const servo::NutPlace& nut, const HexagonLie& lie, const Vec3& p) {
    const Vec3 d = p - nut.seat;
    const Vec3 local(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
    return lie.straighten * (local - Vec3(0, 0, lie.low));
}

}  // namespace bolt::play
