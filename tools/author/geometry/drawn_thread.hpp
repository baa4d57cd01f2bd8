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
// A surface that a screw motion maps to itself contains the direction of that motion. With t: the unit vector
// about the axis y, its normal n satisfies n · (r t + P/2π y) = 0, so that P = −2π r (n·t)/(n·y) on each
// triangle.
std::optional<DrawnThread> measure_drawn_thread(std::span<const Triangle> triangles, double diameter);

}  // namespace bolt::geometry
