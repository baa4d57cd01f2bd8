// Converts radiance to 8-bit sRGB.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::pathtrace {

// Khronos PBR Neutral Tone Mapper (github.com/KhronosGroup/ToneMapping, PBR_Neutral, 2024): colours below 0.8
// keep their hue and value up to the fixed 0.04 of a dielectric's reflection, above they are compressed.
glm::vec3 pbr_neutral(glm::vec3 color);

// IEC 61966-2-1.
float to_srgb(float linear);
float from_srgb(std::uint8_t encoded);

// Radiance times `exposure`, tone mapped, as 8-bit RGB.
std::vector<std::uint8_t> develop(std::span<const glm::vec3> radiance, float exposure);

}  // namespace bolt::pathtrace
