#include "engine/shading/prefilter.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/shading/ggx.hpp"
#include "engine/shading/radical_inverse.hpp"

namespace bolt::shading {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// A direction of the lobe around (0, 0, 1), its weight, and the level of the environment whose texels match
// the sample density.
struct LobeSample {
    glm::vec3 direction;
    float weight;
    float level;
};

std::vector<LobeSample> lobe(float roughness, std::uint32_t count, std::uint32_t size) {
    const float alpha = roughness * roughness;
    const float texel = 4.0F * pi / (6.0F * static_cast<float>(size) * static_cast<float>(size));
    std::vector<LobeSample> samples;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float u = (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
        const float phi = 2.0F * pi * radical_inverse(i);
        const float cosine = std::sqrt((1.0F - u) / (1.0F + (alpha * alpha - 1.0F) * u));
        const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
        const glm::vec3 half(sine * std::cos(phi), sine * std::sin(phi), cosine);
        const glm::vec3 in = 2.0F * cosine * half - glm::vec3(0.0F, 0.0F, 1.0F);
        if (in.z <= 0.0F) continue;
        const float density = ggx(half, glm::vec2(alpha)) / 4.0F;  // D cos / (4 V·H) for N = V
        const float covered = 1.0F / (static_cast<float>(count) * density);
        samples.push_back({in, in.z, std::max(0.0F, 0.5F * std::log2(covered / texel) + 0.5F)});
    }
    return samples;
}

glm::vec3 lookup(const std::vector<Cube>& chain, const glm::vec3& direction, float level) {
    const float top = static_cast<float>(chain.size() - 1);
    const auto lower = static_cast<std::size_t>(std::clamp(level, 0.0F, top));
    const std::size_t upper = std::min(lower + 1, chain.size() - 1);
    const float f = std::clamp(level, 0.0F, top) - static_cast<float>(lower);
    return glm::mix(lookup(chain[lower], direction), lookup(chain[upper], direction), f);
}

}  // namespace

std::vector<Cube> prefilter(const RadianceImage& image, std::uint32_t size, std::uint32_t samples) {
    std::vector<Cube> chain{make_cube(image, size)};
    while (chain.back().size > 1) chain.push_back(halved(chain.back()));
    std::vector<Cube> levels{chain.front()};
    std::size_t count = 1;
    for (std::uint32_t s = size; s > 4; s /= 2) ++count;
    for (std::size_t level = 1; level < count; ++level) {
        const std::vector<LobeSample> directions =
            lobe(level_roughness(level, count), samples << level, size);
        Cube cube{size >> level, {}};
        for (std::uint32_t face = 0; face < 6; ++face) {
            for (std::uint32_t y = 0; y < cube.size; ++y) {
                for (std::uint32_t x = 0; x < cube.size; ++x) {
                    const glm::vec3 n = glm::normalize(cube_direction(face, x, y, cube.size));
                    const glm::vec3 side = std::abs(n.y) < 0.99F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
                    const glm::vec3 t = glm::normalize(glm::cross(side, n));
                    const glm::vec3 b = glm::cross(n, t);
                    glm::vec3 sum(0.0F);
                    float weights = 0.0F;
                    for (const LobeSample& s : directions) {
                        const glm::vec3 d = t * s.direction.x + b * s.direction.y + n * s.direction.z;
                        sum += s.weight * lookup(chain, d, s.level);
                        weights += s.weight;
                    }
                    cube.texels.push_back(sum / weights);
                }
            }
        }
        levels.push_back(std::move(cube));
    }
    return levels;
}

Harmonics diffuse_harmonics(const Cube& cube) {
    Harmonics h{};
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t y = 0; y < cube.size; ++y) {
            for (std::uint32_t x = 0; x < cube.size; ++x) {
                const glm::vec3 d = glm::normalize(cube_direction(face, x, y, cube.size));
                const glm::vec3 light = cube.at(face, x, y) * texel_solid_angle(x, y, cube.size);
                h[0] += light * 0.282095F;
                h[1] += light * 0.488603F * d.y;
                h[2] += light * 0.488603F * d.z;
                h[3] += light * 0.488603F * d.x;
                h[4] += light * 1.092548F * d.x * d.y;
                h[5] += light * 1.092548F * d.y * d.z;
                h[6] += light * 0.315392F * (3.0F * d.z * d.z - 1.0F);
                h[7] += light * 1.092548F * d.x * d.z;
                h[8] += light * 0.546274F * (d.x * d.x - d.y * d.y);
            }
        }
    }
    // The factors π, 2π/3, π/4 of the clamped cosine divided by π, times the polynomials' own factors.
    const float band[] = {1.0F, 2.0F / 3.0F, 0.25F};
    h[0] *= 0.282095F * band[0];
    for (std::size_t i = 1; i < 4; ++i) h[i] *= 0.488603F * band[1];
    for (std::size_t i = 4; i < 9; ++i)
        h[i] *= (i == 6 ? 0.315392F : i == 8 ? 0.546274F : 1.092548F) * band[2];
    return h;
}

glm::vec3 evaluate(const Harmonics& h, const glm::vec3& n) {
    return h[0] + h[1] * n.y + h[2] * n.z + h[3] * n.x + h[4] * (n.x * n.y) + h[5] * (n.y * n.z) +
           h[6] * (3.0F * n.z * n.z - 1.0F) + h[7] * (n.x * n.z) + h[8] * (n.x * n.x - n.y * n.y);
}

}  // namespace bolt::shading
