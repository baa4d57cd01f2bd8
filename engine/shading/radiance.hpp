// Environment radiance by direction.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/assets/radiance_file.hpp"

namespace bolt::shading {

using assets::RadianceImage;

// Maps a unit direction to image coordinates in [0, 1], and back.
glm::vec2 to_square(const glm::vec3& direction);
glm::vec3 to_direction(const glm::vec2& uv);

// Bilinear interpolation that wraps around the seam.
glm::vec3 lookup(const RadianceImage& image, const glm::vec3& direction);

RadianceImage constant(const glm::vec3& radiance);

// A photographer's light table: a large soft box above, one on each side, and a dim background that brightens
// upwards.
RadianceImage studio(int width = 256);

}  // namespace bolt::shading
