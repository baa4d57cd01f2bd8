// Khronos PBR Neutral tone mapping (Khronos 3D Commerce, 2024), as shaders/tone.glsl has it.
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace bolt::render {

inline glm::vec3 pbr_neutral(glm::vec3 color) {
    constexpr float start = 0.8F - 0.04F, d = 1.0F - start;
    const float x = std::min({color.r, color.g, color.b});
    color -= x < 0.08F ? x - 6.25F * x * x : 0.04F;
    const float peak = std::max({color.r, color.g, color.b});
    if (peak < start) return color;
    const float new_peak = 1.0F - d * d / (peak + d - start);
    const float grey = 1.0F - 1.0F / (0.15F * (peak - new_peak) + 1.0F);
    return glm::mix(color * (new_peak / peak), glm::vec3(new_peak), grey);
}

}  // namespace bolt::render
