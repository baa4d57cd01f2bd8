// The direction and the pitch of a thread that a mesh shows as a helix.
#pragma once

#include <optional>
#include <span>

#include "haptics/joint/design.hpp"
#include "tools/author/geometry/bvh.hpp"

namespace bolt::geometry {

struct DrawnThread {
    joint::ThreadDirection direction = joint::ThreadDirection::right;
    double pitch = 0.0;  // m
};

// Measures the flanks of a thread about +Y, with axis through the origin. `diameter`: nominal, m. Returns
// nullopt if the triangles within that diameter are no helix, such as those of a plain shank or of grooves.
//
// At each point of a helical surface, at the distance r from the axis y, the direction of the screw motion is
// tangent to the surface: r t + P/2π y, where t is the unit vector about the axis. The normal n of the
// surface is at right angles to it, so that P = −2π r (n·t)/(n·y) on each triangle.
std::optional<DrawnThread> measure_drawn_thread(std::span<const Triangle> triangles, double diameter);

}  // namespace bolt::geometry
