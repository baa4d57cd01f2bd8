// A cube map on the CPU: six square faces in Vulkan's order and orientation (+X, −X, +Y, −Y, +Z, −Z;
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

// The direction through the middle of a texel; not of unit length.
glm::vec3 cube_direction(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t size);

// The part of the sphere that a texel covers, sr.
float texel_solid_angle(std::uint32_t x, std::uint32_t y, std::uint32_t size);

// Bilinear within a face.
glm::vec3 lookup(const Cube& cube, const glm::vec3& direction);

// Each texel the mean of the image over four points of it.
Cube make_cube(const RadianceImage& image, std::uint32_t size);

// Half the size; the size must be even.
Cube halved(const Cube& cube);

}  // namespace bolt::shading
