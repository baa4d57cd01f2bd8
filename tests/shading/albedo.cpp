#include "engine/shading/ggx.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using namespace bolt::shading;

TEST_CASE("Albedo: a mirror reflects everything, x + y = 1, and y is Schlick's factor") {
    for (const float cosine : {0.2F, 0.5F, 0.9F}) {
        const glm::vec2 e = integrate_albedo(1e-4F, cosine, 512);
        CHECK(e.x + e.y == doctest::Approx(1.0F).epsilon(1e-3));
        CHECK(e.y == doctest::Approx(std::pow(1.0F - cosine, 5.0F)).epsilon(2e-3));
    }
}

TEST_CASE("Albedo: the table equals its integral, and rough layers lose energy in single scattering") {
    for (const float alpha : {0.01F, 0.1F, 0.4F, 1.0F})
        for (const float cosine : {0.05F, 0.3F, 0.7F, 1.0F}) {
            const glm::vec2 exact = integrate_albedo(alpha, cosine, 1 << 16);
            const glm::vec2 table = directional_albedo(alpha, cosine);
            CHECK(std::abs(exact.x - table.x) < 0.006F);
            CHECK(std::abs(exact.y - table.y) < 0.006F);
            CHECK(table.x + table.y <= 1.001F);
        }
    const glm::vec2 rough = directional_albedo(1.0F, 1.0F);
    CHECK(rough.x + rough.y < 0.9F);
}
