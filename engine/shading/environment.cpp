#include "engine/shading/environment.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/shading/ggx.hpp"

namespace bolt::shading {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// A lamp: a rectangle with soft edges on a plane at distance one.
struct SoftBox {
    glm::vec3 towards;    // direction of its centre, any length
    glm::vec2 half_size;  // relative to the distance
    float radiance;
};

// Returns the radiance of a soft box in `direction`.
float radiance_from(const SoftBox& box, const glm::vec3& direction) {
    const glm::vec3 n = glm::normalize(box.towards);
    const float along = glm::dot(direction, n);
    if (along <= 0.05F) return 0.0F;
    const glm::vec3 up = std::abs(n.y) < 0.95F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(up, n));
    const glm::vec2 position(glm::dot(direction, right) / along,
                             glm::dot(direction, glm::cross(n, right)) / along);
    const glm::vec2 inside = box.half_size - glm::abs(position);
    const auto soft = [](float x) { return glm::smoothstep(-0.06F, 0.06F, x); };
    return box.radiance * soft(inside.x) * soft(inside.y);
}

}  // namespace

glm::vec2 to_equirectangular(const glm::vec3& d) {
    return {0.5F + std::atan2(d.x, -d.z) / (2.0F * pi), std::acos(std::clamp(d.y, -1.0F, 1.0F)) / pi};
}

glm::vec3 to_direction(const glm::vec2& uv) {
    const float theta = uv.y * pi;
    const float phi = (uv.x - 0.5F) * 2.0F * pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

glm::vec3 lookup(const RadianceImage& image, const glm::vec3& direction) {
    const glm::vec2 texel = to_equirectangular(direction) * glm::vec2(image.width, image.height) - 0.5F;
    const glm::vec2 corner = glm::floor(texel);
    const glm::vec2 f = texel - corner;
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

RadianceImage constant_environment(const glm::vec3& radiance) {
    return {8, 4, std::vector<glm::vec3>(32, radiance)};
}

RadianceImage studio_environment(int width) {
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
            for (const SoftBox& box : boxes) value += radiance_from(box, d);
            image.pixels.emplace_back(value);
        }
    }
    return image;
}

namespace {

glm::vec3 face_direction(std::uint32_t face, float s, float t) {
    switch (face) {
        case 0:
            return {1.0F, -t, -s};
        case 1:
            return {-1.0F, -t, s};
        case 2:
            return {s, 1.0F, t};
        case 3:
            return {s, -1.0F, -t};
        case 4:
            return {s, -t, 1.0F};
        default:
            return {-s, -t, -1.0F};
    }
}

float centre(std::uint32_t i, std::uint32_t size) {
    return (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(size) - 1.0F;
}

// The solid angle from a face's centre to (s, t): ∫∫ 1/(1 + s² + t²)^{3/2}.
double solid_angle_to(double s, double t) { return std::atan2(s * t, std::sqrt(s * s + t * t + 1.0)); }

}  // namespace

glm::vec3 cube_direction(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t size) {
    return face_direction(face, centre(x, size), centre(y, size));
}

float texel_solid_angle(std::uint32_t x, std::uint32_t y, std::uint32_t size) {
    const double half = 1.0 / static_cast<double>(size);
    const double s = static_cast<double>(centre(x, size)), t = static_cast<double>(centre(y, size));
    return static_cast<float>(solid_angle_to(s - half, t - half) - solid_angle_to(s - half, t + half) -
                              solid_angle_to(s + half, t - half) + solid_angle_to(s + half, t + half));
}

glm::vec3 lookup(const CubeMap& cube, const glm::vec3& d) {
    const glm::vec3 a = glm::abs(d);
    std::uint32_t face = 0;
    float s = 0.0F, t = 0.0F, m = 1.0F;
    if (a.x >= a.y && a.x >= a.z) {
        face = d.x >= 0.0F ? 0 : 1;
        m = a.x;
        s = d.x >= 0.0F ? -d.z : d.z;
        t = -d.y;
    } else if (a.y >= a.z) {
        face = d.y >= 0.0F ? 2 : 3;
        m = a.y;
        s = d.x;
        t = d.y >= 0.0F ? d.z : -d.z;
    } else {
        face = d.z >= 0.0F ? 4 : 5;
        m = a.z;
        s = d.z >= 0.0F ? d.x : -d.x;
        t = -d.y;
    }
    const float size = static_cast<float>(cube.size);
    const float x = std::clamp((s / m + 1.0F) * 0.5F * size - 0.5F, 0.0F, size - 1.0F);
    const float y = std::clamp((t / m + 1.0F) * 0.5F * size - 0.5F, 0.0F, size - 1.0F);
    const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
    const std::uint32_t x1 = std::min(x0 + 1, cube.size - 1), y1 = std::min(y0 + 1, cube.size - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    return glm::mix(glm::mix(cube.at(face, x0, y0), cube.at(face, x1, y0), fx),
                    glm::mix(cube.at(face, x0, y1), cube.at(face, x1, y1), fx), fy);
}

CubeMap make_cube(const RadianceImage& image, std::uint32_t size) {
    CubeMap cube{size, {}};
    cube.texels.reserve(std::size_t{6} * size * size);
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t y = 0; y < size; ++y) {
            for (std::uint32_t x = 0; x < size; ++x) {
                glm::vec3 sum(0.0F);
                for (std::uint32_t k = 0; k < 4; ++k)
                    sum += lookup(
                        image, glm::normalize(cube_direction(face, 2 * x + k % 2, 2 * y + k / 2, 2 * size)));
                cube.texels.push_back(0.25F * sum);
            }
        }
    }
    return cube;
}

CubeMap halved(const CubeMap& cube) {
    CubeMap half{cube.size / 2, {}};
    half.texels.reserve(cube.texels.size() / 4);
    for (std::uint32_t face = 0; face < 6; ++face)
        for (std::uint32_t y = 0; y < half.size; ++y)
            for (std::uint32_t x = 0; x < half.size; ++x)
                half.texels.push_back(0.25F * (cube.at(face, 2 * x, 2 * y) + cube.at(face, 2 * x + 1, 2 * y) +
                                               cube.at(face, 2 * x, 2 * y + 1) +
                                               cube.at(face, 2 * x + 1, 2 * y + 1)));
    return half;
}

namespace {

// A direction of the specular lobe around (0, 0, 1), its weight, and the level of the mip chain whose texels
// match the density of the samples.
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

glm::vec3 lookup(const std::vector<CubeMap>& chain, const glm::vec3& direction, float level) {
    const float top = static_cast<float>(chain.size() - 1);
    const auto lower = static_cast<std::size_t>(std::clamp(level, 0.0F, top));
    const std::size_t upper = std::min(lower + 1, chain.size() - 1);
    const float f = std::clamp(level, 0.0F, top) - static_cast<float>(lower);
    return glm::mix(lookup(chain[lower], direction), lookup(chain[upper], direction), f);
}

}  // namespace

std::vector<CubeMap> prefilter(const RadianceImage& image, std::uint32_t size, std::uint32_t samples) {
    std::vector<CubeMap> chain{make_cube(image, size)};
    while (chain.back().size > 1) chain.push_back(halved(chain.back()));
    std::vector<CubeMap> levels{chain.front()};
    std::size_t count = 1;
    for (std::uint32_t s = size; s > 4; s /= 2) ++count;
    for (std::size_t level = 1; level < count; ++level) {
        const std::vector<LobeSample> lobe_samples =
            lobe(level_roughness(level, count), samples << level, size);
        CubeMap cube{size >> level, {}};
        for (std::uint32_t face = 0; face < 6; ++face) {
            for (std::uint32_t y = 0; y < cube.size; ++y) {
                for (std::uint32_t x = 0; x < cube.size; ++x) {
                    const glm::vec3 n = glm::normalize(cube_direction(face, x, y, cube.size));
                    const glm::vec3 side = std::abs(n.y) < 0.99F ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
                    const glm::vec3 t = glm::normalize(glm::cross(side, n));
                    const glm::vec3 b = glm::cross(n, t);
                    glm::vec3 sum(0.0F);
                    float weights = 0.0F;
                    for (const LobeSample& s : lobe_samples) {
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

Harmonics diffuse_harmonics(const CubeMap& cube) {
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
