#include "tools/verify/pathtrace/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace bolt::pathtrace {

namespace {

struct CameraBasis {
    glm::vec3 right, up, forward;
};

CameraBasis axes(const glm::vec3& forward) {
    const glm::vec3 f = glm::normalize(forward);
    // A vertical view has no projected +Y; −Z replaces it.
    const glm::vec3 up = std::abs(f.y) < 0.9999F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(f, up));
    return {right, glm::cross(right, f), f};
}

}  // namespace

glm::vec3 ray_direction(const PinholeCamera& camera, const glm::vec2& pixel) {
    const CameraBasis a = axes(camera.target - camera.eye);
    const float half = std::tan(0.5F * camera.fov);
    const float scale = 2.0F * half / static_cast<float>(camera.height);
    const float x = (pixel.x - 0.5F * static_cast<float>(camera.width)) * scale;
    const float y = (0.5F * static_cast<float>(camera.height) - pixel.y) * scale;
    return glm::normalize(a.forward + x * a.right + y * a.up);
}

PinholeCamera frame_box(const PinholeCamera& camera, const glm::vec3& low, const glm::vec3& high,
                        const glm::vec3& view) {
    const CameraBasis a = axes(-view);
    const glm::vec3 middle = 0.5F * (low + high);
    const float margin = 1.06F;
    const float tan_y = std::tan(0.5F * camera.fov) / margin;
    const float tan_x = tan_y * static_cast<float>(camera.width) / static_cast<float>(camera.height);
    float distance = 0.0F;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p = glm::vec3((corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                      (corner & 4) != 0 ? high.z : low.z) -
                            middle;
        const float depth = glm::dot(p, a.forward);
        distance = std::max({distance, std::abs(glm::dot(p, a.right)) / tan_x - depth,
                             std::abs(glm::dot(p, a.up)) / tan_y - depth});
    }
    PinholeCamera framed = camera;
    framed.target = middle;
    framed.eye = middle - a.forward * std::max(distance, 1e-3F);
    return framed;
}

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

std::vector<std::uint8_t> to_srgb8(std::span<const glm::vec3> radiance, float exposure) {
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
