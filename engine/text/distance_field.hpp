// A glyph as the distance to its edge (C. Green, Improved Alpha-Tested Magnification for Vector Textures,
// 2007): drawn at any size and angle, the edge is found between the texels and is as sharp as the picture
// allows. Distances are exact, to the outline itself and not to pixels of a raster.
#pragma once

#include "engine/text/face.hpp"

namespace bolt::text {

struct DistanceField {
    int width = 0, height = 0;
    glm::dvec2 low{0.0};           // em, where the first texel's lower left corner is
    std::vector<float> distances;  // em, positive inside, rows from below; held between −reach and reach
};

// Nothing for an outline without area. The field is `reach` (em) larger than the outline on every side.
DistanceField distance_field(const Outline& outline, double texels_per_em, double reach);

}  // namespace bolt::text
