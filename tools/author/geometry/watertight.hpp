// Whether a part's surface is closed.
#pragma once

#include <span>

#include "tools/author/geometry/box.hpp"

namespace bolt::geometry {

struct OpenEdges {
    std::size_t count = 0;
    Vec3 first{0.0};  // the middle of one of them
};

// Edges that no triangle runs through the other way. Corners are the same where their coordinates are exactly
// equal.
OpenEdges open_edges(std::span<const Triangle> triangles);

}  // namespace bolt::geometry
