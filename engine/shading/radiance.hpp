// Light from all around, as an equirectangular image of radiance: the middle column is −Z, the right half +X,
// the top row +Y.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace bolt::shading {

struct RadianceImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // rows from the top
};

// Where a unit direction lies in the image, both in [0, 1], and back.
glm::vec2 to_square(const glm::vec3& direction);
glm::vec3 to_direction(const glm::vec2& uv);

// Bilinear, around the seam.
glm::vec3 lookup(const RadianceImage& image, const glm::vec3& direction);

RadianceImage constant(const glm::vec3& radiance);

// The light of a photographer's table: a large soft box above, one to either side, a dim surrounding that
// brightens upwards.
RadianceImage studio(int width = 512);

}  // namespace bolt::shading
