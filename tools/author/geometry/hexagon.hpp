// A hexagon about +Y, measured off its mesh.
#pragma once

#include <optional>
#include <span>

#include "tools/author/geometry/box.hpp"

namespace bolt::geometry {

struct Hexagon {
    double across_flats = 0.0;     // m, mean of the three widths
    double unevenness = 0.0;       // m, the widest less the narrowest
    Vec3 centre{0.0};              // m, beside the axis; y is 0
    double low = 0.0, high = 0.0;  // m, along the axis
};

// None if the triangles show no six flats about the axis.
std::optional<Hexagon> measure_hexagon(std::span<const Triangle> triangles);

}  // namespace bolt::geometry
