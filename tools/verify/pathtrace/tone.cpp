#include "tools/verify/pathtrace/tone.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

namespace bolt::pathtrace {

glm::vec3 pbr_neutral(glm::vec3 color) {
    constexpr float start_compression = 0.8F - 0.04F;
    constexpr float desaturation = 0.15F;
    const float x = std::min({color.r, color.g, color.b});
    color -= x < 0.08F ? x - 6.25F * x * x : 0.04F;
    const float peak = std::max({color.r, color.g, color.b});
    if (peak < start_compression) return color;
    constexpr float d = 1.0F - start_compression;
    const float new_peak = 1.0F - d * d / (peak + d - start_compression);
    color *= new_peak / peak;
    const float g = 1.0F - 1.0F / (desaturation * (peak - new_peak) + 1.0F);
    return glm::mix(color, glm::vec3(new_peak), g);
}

float to_srgb(float linear) {
    const float x = std::clamp(linear, 0.0F, 1.0F);
    return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

float from_srgb(std::uint8_t encoded) {
    static const auto table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            const float x = static_cast<float>(i) / 255.0F;
            values[i] = x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
        }
        return values;
    }();
    return table[encoded];
}

std::vector<std::uint8_t> develop(std::span<const glm::vec3> radiance, float exposure) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(radiance.size() * 3);
    for (const glm::vec3& value : radiance) {
        const glm::vec3 color = pbr_neutral(value * exposure);
        for (int c = 0; c < 3; ++c)
            bytes.push_back(static_cast<std::uint8_t>(std::lround(to_srgb(color[c]) * 255.0F)));
    }
    return bytes;
}

}  // namespace bolt::pathtrace
