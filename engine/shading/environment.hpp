// Environment light: radiance by direction, cube maps, and prefiltering for image-based lighting.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/assets/image.hpp"

namespace bolt::shading {

using assets::RadianceImage;

// Maps a unit direction to image coordinates in [0, 1], and back.
glm::vec2 to_equirectangular(const glm::vec3& direction);
glm::vec3 to_direction(const glm::vec2& uv);

// Bilinear interpolation that wraps around the seam.
glm::vec3 lookup(const RadianceImage& image, const glm::vec3& direction);

// Returns an environment with the same radiance in every direction.
RadianceImage constant_environment(const glm::vec3& radiance);

// Returns a photographer's studio: soft boxes above, on both sides and behind, and a dim background that
// becomes brighter upwards. `width`: of the image, pixels.
RadianceImage studio_environment(int width = 256);

// A cube map on the CPU: six square faces in Vulkan's order and orientation (+X, -X, +Y, -Y, +Z, -Z;
// specification, "Cube Map Face Selection").
struct CubeMap {
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
glm::vec3 lookup(const CubeMap& cube, const glm::vec3& direction);

// Resamples an image into a cube map; each texel is the mean of four points.
CubeMap make_cube(const RadianceImage& image, std::uint32_t size);

// Returns the cube map at half its size. The size must be even.
CubeMap halved(const CubeMap& cube);

// Returns the roughness of a prefiltered level: linear from 0 (the environment itself) to 1.
inline float level_roughness(std::size_t level, std::size_t levels) {
    return static_cast<float>(level) / static_cast<float>(levels - 1);
}

// Convolves the environment with specular lobes of increasing roughness. Each level has half the size of the
// previous one, down to 4 texels, and uses twice the samples for a quarter of the texels. The lobe is GGX for
// N = V, as in split-sum shading (B. Karis, Real Shading in Unreal Engine 4, 2013), integrated by filtered
// importance sampling (J. Křivánek and M. Colbert, Real-time Shading with Filtered Importance Sampling, EGSR
// 2008). `size`: texels per side of a face of level 0. Level i uses `samples` · 2ⁱ directions for each texel.
std::vector<CubeMap> prefilter(const RadianceImage& image, std::uint32_t size, std::uint32_t samples = 32);

// Radiance reflected by a white diffuse surface, irradiance / π, in the first nine real spherical harmonics
// with the polynomials' factors folded in (R. Ramamoorthi and P. Hanrahan, An Efficient Representation for
// Irradiance Environment Maps, SIGGRAPH 2001).
using Harmonics = std::array<glm::vec3, 9>;
Harmonics diffuse_harmonics(const CubeMap& cube);
glm::vec3 evaluate(const Harmonics& harmonics, const glm::vec3& normal);

}  // namespace bolt::shading
