// Image-based light, prepared: the environment convolved with the specular lobe for a chain of roughnesses,
// and its irradiance in spherical harmonics.
#pragma once

#include <array>

#include "engine/shading/cube.hpp"

namespace bolt::shading {

// The roughness that a level holds: evenly from 0 (the environment itself) to 1.
inline float level_roughness(std::size_t level, std::size_t levels) {
    return static_cast<float>(level) / static_cast<float>(levels - 1);
}

// Levels of half the size each, down to 4; each takes twice the samples of the one before, for a quarter of
// the texels. The lobe is GGX seen from the normal (N = V: what split-sum shading looks up; B. Karis, Real
// Shading in Unreal Engine 4, 2013), by importance sampling with samples that are themselves filtered (J.
// Křivánek and M. Colbert, Real-time Shading with Filtered Importance Sampling, EGSR 2008).
std::vector<Cube> prefilter(const RadianceImage& image, std::uint32_t size, std::uint32_t samples = 32);

// Radiance that a white diffuse surface gives back: irradiance / π, in the first nine real spherical
// harmonics, the polynomials' factors folded in (R. Ramamoorthi and P. Hanrahan, An Efficient Representation
// for Irradiance Environment Maps, SIGGRAPH 2001).
using Harmonics = std::array<glm::vec3, 9>;
Harmonics diffuse_harmonics(const Cube& cube);
glm::vec3 evaluate(const Harmonics& harmonics, const glm::vec3& normal);

}  // namespace bolt::shading
