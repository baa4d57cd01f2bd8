// Image-based lighting: the environment convolved with specular lobes of increasing roughness, and its
// irradiance in spherical harmonics.
#pragma once

#include <array>

#include "engine/shading/cube.hpp"

namespace bolt::shading {

// The roughness of a level: linear from 0 (the environment itself) to 1.
inline float level_roughness(std::size_t level, std::size_t levels) {
    return static_cast<float>(level) / static_cast<float>(levels - 1);
}

// Levels of half the size each, down to 4; each uses twice the samples of the previous one for a quarter of
// the texels. The lobe is GGX for N = V, as in split-sum shading (B. Karis, Real Shading in Unreal Engine 4,
// 2013), integrated by filtered importance sampling (J. Křivánek and M. Colbert, Real-time Shading with
// Filtered Importance Sampling, EGSR 2008).
std::vector<Cube> prefilter(const RadianceImage& image, std::uint32_t size, std::uint32_t samples = 32);

// Radiance reflected by a white diffuse surface, irradiance / π, in the first nine real spherical harmonics
// with the polynomials' factors folded in (R. Ramamoorthi and P. Hanrahan, An Efficient Representation for
// Irradiance Environment Maps, SIGGRAPH 2001).
using Harmonics = std::array<glm::vec3, 9>;
Harmonics diffuse_harmonics(const Cube& cube);
glm::vec3 evaluate(const Harmonics& harmonics, const glm::vec3& normal);

}  // namespace bolt::shading
