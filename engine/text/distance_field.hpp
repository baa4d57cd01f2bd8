// Signed distance fields of glyphs (C. Green, Improved Alpha-Tested Magnification for Vector Textures, 2007),
// for sharp edges at every size and angle. Distances are computed from the outline itself, not from a raster.
#pragma once

#include "engine/text/face.hpp"

namespace bolt::text {

struct DistanceField {
    int width = 0, height = 0;
    glm::dvec2 low{0.0};           // em, lower left corner of the first texel
    std::vector<float> distances;  // em, positive inside, rows from the bottom; clamped to [-reach, reach]
};

// Returns an empty field for an outline without area. The field extends `reach` (em) beyond the outline on
// every side.
DistanceField distance_field(const Outline& outline, double texels_per_em, double reach);

}  // namespace bolt::text
