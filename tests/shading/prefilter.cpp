#include "engine/shading/environment.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

using namespace bolt::shading;

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// Light from the upper hemisphere only.
RadianceImage sky() {
    RadianceImage image{64, 32, {}};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) image.pixels.emplace_back(y < 16 ? 1.0F : 0.0F);
    return image;
}

}  // namespace

TEST_CASE("Cube map: texels cover the sphere once, and a texel's direction maps to that texel") {
    for (const std::uint32_t size : {1U, 2U, 8U}) {
        double sum = 0.0;
        for (std::uint32_t y = 0; y < size; ++y)
            for (std::uint32_t x = 0; x < size; ++x)
                sum += 6.0 * static_cast<double>(texel_solid_angle(x, y, size));
        CHECK(sum == doctest::Approx(4.0 * std::numbers::pi).epsilon(1e-5));
    }
    CubeMap cube{8, {}};
    for (int i = 0; i < 6 * 64; ++i) cube.texels.emplace_back(static_cast<float>(i));
    for (std::uint32_t face = 0; face < 6; ++face)
        for (std::uint32_t y = 0; y < 8; ++y)
            for (std::uint32_t x = 0; x < 8; ++x)
                CHECK(lookup(cube, cube_direction(face, x, y, 8)).x ==
                      doctest::Approx(cube.at(face, x, y).x).epsilon(1e-4));
}

TEST_CASE("Prefilter: white surroundings stay white at every roughness and in the diffuse light") {
    const std::vector<CubeMap> levels = prefilter(constant_environment(glm::vec3(1.0F, 0.5F, 0.25F)), 32);
    REQUIRE(levels.size() == 4);
    CHECK(levels.back().size == 4);
    for (const CubeMap& level : levels)
        for (const glm::vec3& texel : level.texels) {
            REQUIRE(texel.x == doctest::Approx(1.0F).epsilon(1e-4));
            REQUIRE(texel.z == doctest::Approx(0.25F).epsilon(1e-4));
        }
    const Harmonics h = diffuse_harmonics(levels[0]);
    for (const glm::vec3& n : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::normalize(glm::vec3(1, 2, 3))})
        CHECK(evaluate(h, n).y == doctest::Approx(0.5F).epsilon(0.001));
}

TEST_CASE(
    "Prefilter: under a bright upper hemisphere irradiance is (1 + cos)/2 within 2 %, and reflections are "
    "bright upwards") {
    const std::vector<CubeMap> levels = prefilter(sky(), 64);
    const Harmonics h = diffuse_harmonics(levels[0]);
    for (float angle = 0.0F; angle <= pi; angle += 0.1F) {
        const glm::vec3 n(std::sin(angle), std::cos(angle), 0.0F);
        CHECK(std::abs(evaluate(h, n).x - 0.5F * (1.0F + std::cos(angle))) < 0.02F);
    }
    for (const CubeMap& level : levels) {
        CHECK(lookup(level, {0, 1, 0}).x > 0.94F);
        CHECK(lookup(level, {0, -1, 0}).x < 0.06F);
    }
    // With roughness, the transition between bright and dark widens.
    const auto step = [&](std::size_t level) {
        return lookup(levels[level], {1, 0.3F, 0}).x - lookup(levels[level], {1, -0.3F, 0}).x;
    };
    for (std::size_t level = 1; level < levels.size(); ++level) CHECK(step(level) <= step(level - 1) + 1e-3F);
}
