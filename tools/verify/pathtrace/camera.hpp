// The camera: position, directions and angle of view.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::pathtrace {

struct Camera {
    glm::vec3 eye{0.0F, 0.0F, 1.0F};
    glm::vec3 target{0.0F};
    float fov = 0.6108652F;  // vertical, rad
    int width = 800, height = 600;
};

// The ray through a point of the picture in pixels from its top left corner; of unit length.
glm::vec3 direction(const Camera& camera, const glm::vec2& pixel);

// A camera that sees the box `low`–`high` from `view` (towards the viewer), filling the picture.
Camera frame(const Camera& camera, const glm::vec3& low, const glm::vec3& high, const glm::vec3& view);

// Converts radiance to 8-bit sRGB.

// Khronos PBR Neutral Tone Mapper (github.com/KhronosGroup/ToneMapping, PBR_Neutral, 2024): colours below 0.8
// keep their hue and value up to the fixed 0.04 of a dielectric's reflection, above they are compressed.
glm::vec3 pbr_neutral(glm::vec3 color);

// IEC 61966-2-1.
float to_srgb(float linear);
float from_srgb(std::uint8_t encoded);

// Radiance times `exposure`, tone mapped, as 8-bit RGB.
std::vector<std::uint8_t> develop(std::span<const glm::vec3> radiance, float exposure);

}  // namespace bolt::pathtrace
