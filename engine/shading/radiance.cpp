#include "engine/shading/radiance.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace bolt::shading {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// The brightness of a soft box in `direction`: a rectangle on a plane at distance one, with soft edges.
struct SoftBox {
    glm::vec3 towards;    // direction of its centre, any length
    glm::vec2 half_size;  // relative to the distance
    float radiance;
};

float brightness(const SoftBox& box, const glm::vec3& direction) {
    const glm::vec3 n = glm::normalize(box.towards);
    const float along = glm::dot(direction, n);
    if (along <= 0.05F) return 0.0F;
    const glm::vec3 up = std::abs(n.y) < 0.95F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(up, n));
    const glm::vec2 place(glm::dot(direction, right) / along,
                          glm::dot(direction, glm::cross(n, right)) / along);
    const glm::vec2 inside = box.half_size - glm::abs(place);
    const auto soft = [](float x) { return glm::smoothstep(-0.06F, 0.06F, x); };
    return box.radiance * soft(inside.x) * soft(inside.y);
}

}  // namespace

glm::vec2 to_square(const glm::vec3& d) {
    return {0.5F + std::atan2(d.x, -d.z) / (2.0F * pi), std::acos(std::clamp(d.y, -1.0F, 1.0F)) / pi};
}

glm::vec3 to_direction(const glm::vec2& uv) {
    const float theta = uv.y * pi;
    const float phi = (uv.x - 0.5F) * 2.0F * pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

glm::vec3 lookup(const RadianceImage& image, const glm::vec3& direction) {
    const glm::vec2 place = to_square(direction) * glm::vec2(image.width, image.height) - 0.5F;
    const glm::vec2 corner = glm::floor(place);
    const glm::vec2 f = place - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    const auto at = [&](int px, int py) {
        const int column = (px + image.width) % image.width;
        const int row = std::clamp(py, 0, image.height - 1);
        return image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                            static_cast<std::size_t>(column)];
    };
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), f.x), glm::mix(at(x, y + 1), at(x + 1, y + 1), f.x),
                    f.y);
}

RadianceImage constant(const glm::vec3& radiance) { return {8, 4, std::vector<glm::vec3>(32, radiance)}; }

RadianceImage studio(int width) {
    const SoftBox boxes[] = {
        {{-0.55F, 1.0F, 0.65F}, {0.55F, 0.45F}, 3.6F},  // key, above on the left
        {{1.0F, 0.35F, 0.35F}, {0.35F, 0.75F}, 1.3F},   // fill, on the right
        {{-0.9F, 0.25F, -0.75F}, {0.18F, 0.9F}, 2.6F},  // rim, behind on the left
        {{0.5F, 0.5F, -1.0F}, {0.7F, 0.18F}, 1.6F},     // strip behind
    };
    RadianceImage image{width, width / 2, {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::vec3 d =
                to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(image.width),
                              (static_cast<float>(y) + 0.5F) / static_cast<float>(image.height)});
            float value = glm::mix(0.06F, 0.30F, glm::smoothstep(-0.6F, 1.0F, d.y));
            for (const SoftBox& box : boxes) value += brightness(box, d);
            image.pixels.emplace_back(value);
        }
    }
    return image;
}

}  // namespace bolt::shading
