// Tests of the environment light and of tone mapping.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/pathtrace/about.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/environment.hpp"
#include "tools/verify/pathtrace/sampler.hpp"

using namespace bolt::pathtrace;
using bolt::about;

TEST_CASE("Environment: sampling estimates the same light as the integral over the sphere") {
    const Environment environment(studio_environment(128));
    double direct = 0.0;
    double density = 0.0;
    constexpr int rows = 512;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < 2 * rows; ++x) {
            const float theta = std::numbers::pi_v<float> * (static_cast<float>(y) + 0.5F) / rows;
            const float phi = std::numbers::pi_v<float> * (static_cast<float>(x) + 0.5F) / rows;
            const glm::vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta),
                              -std::sin(theta) * std::cos(phi));
            const double area =
                std::numbers::pi / rows * std::numbers::pi / rows * static_cast<double>(std::sin(theta));
            direct += static_cast<double>(environment.radiance(d).x) * area;
            density += static_cast<double>(environment.density(d)) * area;
        }
    }
    double sampled = 0.0;
    constexpr std::uint32_t count = 1U << 15U;
    for (std::uint32_t i = 0; i < count; ++i) {
        const DirectionSample light = environment.sample(SobolSampler(0, 0, i).pair());
        CHECK(glm::length(light.direction) == about(1.0F));
        sampled += static_cast<double>(environment.radiance(light.direction).x / light.density) / count;
    }
    CHECK(density == about(1.0).epsilon(0.01));
    CHECK(sampled == about(direct).epsilon(0.01));
}

TEST_CASE("Environment: the image has −Z in the middle, +X to the right and +Y at the top") {
    RadianceImage image = constant_environment(glm::vec3(0.0F));
    image.width = 64;
    image.height = 32;
    image.pixels.assign(64 * 32, glm::vec3(0.0F));
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            auto& pixel = image.pixels[static_cast<std::size_t>(y * 64 + x)];
            if (std::abs(x - 32) < 4) pixel.r = 1.0F;
            if (std::abs(x - 48) < 4) pixel.g = 1.0F;
            if (y < 4) pixel.b = 1.0F;
        }
    }
    const Environment environment(image);
    CHECK(environment.radiance({0, 0, -1}) == glm::vec3(1, 0, 0));
    CHECK(environment.radiance({1, 0, 0}) == glm::vec3(0, 1, 0));
    CHECK(environment.radiance({0, 1, 0}).b == 1.0F);
    CHECK(environment.radiance({0, 0, 1}) == glm::vec3(0.0F));
}

TEST_CASE("Environment: without an image the radiance is zero") {
    const Environment environment;
    CHECK(environment.dark());
    CHECK(environment.radiance({0, 1, 0}) == glm::vec3(0.0F));
}

TEST_CASE("Tone mapping: the curve has the reference values of Khronos PBR Neutral") {
    // A grey of 0.04 (reflection of a dielectric on black) is in the toe of the curve, 6.25 x².
    CHECK(pbr_neutral(glm::vec3(0.0F)) == glm::vec3(0.0F));
    CHECK(pbr_neutral(glm::vec3(0.04F)).r == about(6.25F * 0.04F * 0.04F));
    CHECK(pbr_neutral(glm::vec3(0.5F)).r == about(0.46F));
    // The curve is continuous where compression starts, and stays below one.
    CHECK(pbr_neutral(glm::vec3(0.8001F)).r == about(0.76F).epsilon(0.001));
    float last = 0.0F;
    for (float x = 0.0F; x < 50.0F; x += 0.1F) {
        const glm::vec3 mapped = pbr_neutral({x, 0.5F * x, 0.0F});
        CHECK(mapped.r >= last);
        CHECK(mapped.r < 1.0F);
        last = mapped.r;
    }
}

TEST_CASE("Tone mapping: decoding and encoding returns every 8-bit value") {
    for (int i = 0; i < 256; ++i) {
        const float linear = from_srgb(static_cast<std::uint8_t>(i));
        CHECK(std::lround(to_srgb(linear) * 255.0F) == i);
    }
}
