// How far a solid's surface is at least, and at most, without asking it: an octree of its distance, fine near
// the surface only. Good for setting aside what is far and for telling outside; never for what is felt.
//
// The distance changes by no more than the way made, so that of a cell's middle bounds that of every point of
// it.
#pragma once

#include <cstdint>

#include "haptics/contact/solid.hpp"

namespace bolt::contact {

struct DistanceGrid {
    struct Node {
        float distance;          // m, signed, at the middle
        std::uint32_t children;  // the first of eight; 0: none
    };
    Vec3 low{0.0};               // m, of the first root cell
    double root = 0.0;           // m, the size of a root cell
    float per_root = 0.0F;       // 1 / root
    double rounding = 0.0;       // m: more than what points and distances in float are off by
    std::array<int, 3> roots{};  // along each axis; 0: no grid
    std::vector<Node> nodes;     // root cells first, x fastest
};

// Cells as small as `cell` (m) near the surface, and as far around the solid's box as a root cell reaches.
DistanceGrid make_distance_grid(const Solid& solid, double cell);

// Of a point's distance: `lower` <= signed distance, |signed distance| <= `upper`.
struct DistanceBounds {
    double lower = -nothing_near, upper = nothing_near;
};

// Beyond the grid, and without one, nothing is told.
DistanceBounds distance_bounds(const DistanceGrid& grid, const Vec3& point);

}  // namespace bolt::contact
