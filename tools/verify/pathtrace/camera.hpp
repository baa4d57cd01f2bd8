// The pinhole camera of the path tracer, and the conversion of radiance to 8-bit sRGB.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace bolt::pathtrace {

struct PinholeCamera {
    glm::vec3 eye{0.0F, 0.0F, 1.0F};
    glm::vec3 target{0.0F};
    float fov = 0.6108652F;  // vertical, rad
    int width = 800, height = 600;
};

// Returns the unit direction of the ray through a point of the image, in pixels from the top left corner.
glm::vec3 ray_direction(const PinholeCamera& camera, const glm::vec2& pixel);

// Returns the camera moved so that the box from `low` to `high` fills the image. `view` is the direction from
// the box to the viewer.
PinholeCamera frame_box(const PinholeCamera& camera, const glm::vec3& low, const glm::vec3& high,
                        const glm::vec3& view);

// Khronos PBR Neutral Tone Mapper (github.com/KhronosGroup/ToneMapping, PBR_Neutral, 2024): colours below 0.8
// keep their hue and value except for the 0.04 of a dielectric's reflection; colours above are compressed.
glm::vec3 pbr_neutral(glm::vec3 color);

// Transfer functions of IEC 61966-2-1.
float to_srgb(float linear);
float from_srgb(std::uint8_t encoded);

// Returns radiance times `exposure`, tone mapped, as 8-bit RGB.
std::vector<std::uint8_t> to_srgb8(std::span<const glm::vec3> radiance, float exposure);

}  // namespace bolt::pathtrace
