// Tests of the lighting model against analytic and integral properties.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/shading/ggx.hpp"
#include "tests/pathtrace/about.hpp"
#include "tools/verify/pathtrace/bsdf.hpp"
#include "tools/verify/pathtrace/sampler.hpp"

using namespace bolt::pathtrace;
using namespace bolt::shading;
using bolt::about;

namespace {

glm::vec3 at(float cosine) { return {std::sqrt(1.0F - cosine * cosine), 0.0F, cosine}; }

ShadingPoint white(float roughness, float metallic, float coat) {
    ShadingPoint s;
    s.metallic = metallic;
    s.alpha = glm::vec2(std::max(roughness * roughness, min_alpha));
    s.coat = coat;
    s.coat_alpha = 0.01F;
    return s;
}

// Returns, by sampling, the fraction of the light of white surroundings that is reflected to `out`.
float furnace(const ShadingPoint& s, const glm::vec3& out, std::uint32_t count) {
    glm::dvec3 sum(0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        SobolSampler sampler(7, 11, i);
        const float pick = sampler.single();
        sum += glm::dvec3(Bsdf(s, out).sample(pick, sampler.pair()).weight);
    }
    return static_cast<float>(sum.x / count);
}

}  // namespace

TEST_CASE("BSDF: a white surface reflects all light at every roughness and angle, within 1 %") {
    for (const float metallic : {0.0F, 0.5F, 1.0F}) {
        for (const float coat : {0.0F, 1.0F}) {
            for (const float roughness : {0.05F, 0.2F, 0.4F, 0.6F, 0.8F, 1.0F}) {
                for (const float cosine : {0.1F, 0.3F, 0.6F, 0.99F}) {
                    CAPTURE(metallic);
                    CAPTURE(coat);
                    CAPTURE(roughness);
                    CAPTURE(cosine);
                    const float white_light = furnace(white(roughness, metallic, coat), at(cosine), 4096);
                    CHECK(white_light == about(1.0F).epsilon(0.01));
                }
            }
        }
    }
}

TEST_CASE("BSDF: brushed metal reflects the expected light within a few per cent, averaged over directions") {
    for (const float strength : {0.25F, 0.5F, 1.0F}) {
        for (const float roughness : {0.1F, 0.25F, 0.5F, 0.8F}) {
            for (const float cosine : {0.1F, 0.3F, 0.9F}) {
                ShadingPoint s = white(roughness, 1.0F, 0.0F);
                s.alpha.x = glm::mix(s.alpha.x, 1.0F, strength * strength);
                float sum = 0.0F;
                for (int i = 0; i < 5; ++i) {
                    const float azimuth = static_cast<float>(i) * pi_float / 8.0F;
                    const float sine = std::sqrt(1.0F - cosine * cosine);
                    sum +=
                        furnace(s, {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}, 1024) / 5.0F;
                }
                CAPTURE(strength);
                CAPTURE(roughness);
                CAPTURE(cosine);
                CHECK(sum == about(1.0F).epsilon(strength < 1.0F ? 0.04 : 0.08));
            }
        }
    }
}

TEST_CASE(
    "BSDF: without compensation rough metal loses a quarter of the light, so the furnace test can fail") {
    const glm::vec2 ab = integrate_albedo(1.0F, 0.6F, 4096);
    CHECK(ab.x + ab.y < 0.72F);
    // A mirror loses no light, and its F90 term is Schlick's.
    const glm::vec2 mirror = integrate_albedo(1e-3F, 0.5F, 4096);
    CHECK(mirror.x + mirror.y == about(1.0F).epsilon(1e-3));
    CHECK(mirror.y == about(pow5(0.5F)).epsilon(0.01));
}

TEST_CASE("BSDF: the albedo table agrees with its integral") {
    for (const float roughness : {0.13F, 0.37F, 0.71F, 0.93F}) {
        for (const float cosine : {0.05F, 0.23F, 0.52F, 0.87F}) {
            const glm::vec2 table = directional_albedo(roughness * roughness, cosine);
            const glm::vec2 exact = integrate_albedo(roughness * roughness, cosine, 65536);
            CAPTURE(roughness);
            CAPTURE(cosine);
            CHECK(table.x == about(exact.x).epsilon(0.004));
            CHECK(std::abs(table.y - exact.y) < 0.002F);
        }
    }
}

TEST_CASE("BSDF: sampling agrees with evaluation over uniform directions") {
    ShadingPoint s = white(0.5F, 0.3F, 0.6F);
    s.base_color = {0.8F, 0.4F, 0.1F};
    s.alpha = {0.4F, 0.15F};
    s.coat_alpha = 0.2F;
    const glm::vec3 out = glm::normalize(glm::vec3(0.5F, 0.3F, 0.8F));
    glm::dvec3 uniform(0.0);
    double density = 0.0;
    constexpr std::uint32_t count = 1U << 17U;
    for (std::uint32_t i = 0; i < count; ++i) {
        SobolSampler sampler(1, 2, i);
        const glm::vec2 u = sampler.pair();
        const float r = std::sqrt(1.0F - u.x * u.x);
        const glm::vec3 in(r * std::cos(2.0F * pi_float * u.y), r * std::sin(2.0F * pi_float * u.y), u.x);
        const BsdfValue scattered = Bsdf(s, out).evaluate(in);
        uniform += glm::dvec3(scattered.value) * (2.0 * std::numbers::pi / count);
        density += static_cast<double>(scattered.density) * (2.0 * std::numbers::pi / count);
    }
    glm::dvec3 sampled(0.0);
    for (std::uint32_t i = 0; i < count; ++i) {
        SobolSampler sampler(3, 4, i);
        const float pick = sampler.single();
        sampled += glm::dvec3(Bsdf(s, out).sample(pick, sampler.pair()).weight) / static_cast<double>(count);
    }
    for (int c = 0; c < 3; ++c) CHECK(sampled[c] == about(uniform[c]).epsilon(0.01));
    // Sampling visible normals sends a few rays below the horizon, where the BSDF is zero.
    CHECK(density <= 1.005);
    CHECK(density > 0.93);
}

TEST_CASE("BSDF: the distribution of normals is normalised by its projected area") {
    for (const float alpha : {0.1F, 0.5F, 1.0F}) {
        double area = 0.0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const float cosine = (static_cast<float>(i) + 0.5F) / steps;
            area += static_cast<double>(ggx(at(cosine), glm::vec2(alpha)) * cosine) * 2.0 * std::numbers::pi /
                    steps;
        }
        CHECK(area == about(1.0).epsilon(1e-3));
    }
}

TEST_CASE("BSDF: directions below the surface reflect no light") {
    const ShadingPoint s = white(0.5F, 0.0F, 0.0F);
    CHECK(Bsdf(s, at(0.5F)).evaluate(-at(0.5F)).value == glm::vec3(0.0F));
    CHECK(Bsdf(s, -at(0.5F)).evaluate(at(0.5F)).value == glm::vec3(0.0F));
    CHECK(Bsdf(s, -at(0.5F)).sample(0.5F, {0.5F, 0.5F}).density == 0.0F);
}
