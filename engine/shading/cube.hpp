// A cube map on the CPU: six square faces in Vulkan's order and orientation (+X, -X, +Y, -Y, +Z, -Z;
// specification, "Cube Map Face Selection").
#pragma once

#include <cstdint>

#include "engine/shading/radiance.hpp"

namespace bolt::shading {

struct Cube {
    std::uint32_t size = 0;
    std::vector<glm::vec3> texels;  // face by face, rows from the top

    [[nodiscard]] const glm::vec3& at(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
        return texels[(std::size_t{face} * size + y) * size + x];
    }
};

// Returns the direction through a texel's centre, not normalised.
glm::vec3 cube_direction(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t size);

// Returns the solid angle of a texel, sr.
float texel_solid_angle(std::uint32_t x, std::uint32_t y, std::uint32_t size);

// Bilinear interpolation within a face.
glm::vec3 lookup(const Cube& cube, const glm::vec3& direction);

// Resamples the image; each texel is the mean of four points.
Cube make_cube(const RadianceImage& image, std::uint32_t size);

// Returns the map at half its size, which must be even.
Cube halved(const Cube& cube);

}  // namespace bolt::shading
