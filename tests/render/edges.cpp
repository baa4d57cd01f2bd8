// Artefacts that multisampling must not cause at edges.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/assets/gltf.hpp"
#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr std::uint32_t scale = 4;
constexpr VkExtent2D small{256, 192}, large{scale * small.width, scale*small.height};

int brightness(const glm::ivec4& p) { return (p.x + 2 * p.y + p.z) / 4; }

// Returns the brightest value of the larger picture around this pixel of the small one, with a margin of half
// a small pixel.
int brightest(const Picture& picture, std::uint32_t x, std::uint32_t y) {
    const auto range = [](std::uint32_t at, std::uint32_t size) {
        const std::uint32_t first = at * scale, margin = scale / 2;
        return std::pair{first - std::min(first, margin), std::min(first + scale + margin, size)};
    };
    const auto [left, right] = range(x, picture.width);
    const auto [top, bottom] = range(y, picture.height);
    int most = 0;
    for (std::uint32_t v = top; v < bottom; ++v)
        for (std::uint32_t u = left; u < right; ++u)
            most = std::max(most, brightness(test::pixel(picture, u, v)));
    return most;
}

// Returns the number of pixels that are much brighter than everything in the scene.
int sparks(const Picture& picture, const Picture& reference) {
    int count = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x)
            if (brightness(test::pixel(picture, x, y)) > brightest(reference, x, y) + 12) ++count;
    return count;
}

}  // namespace

TEST_CASE("Edges: rounded edges cause no pixel brighter than the scene") {
    const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(folder != nullptr);
    const auto model = assets::read_gltf(std::filesystem::path(folder) / "assemblies/zq350/zq350.glb");
    REQUIRE(model.has_value());
    test::Studio studio;
    const GpuModel gpu_model = studio.upload(*model);
    const EnvironmentLight light = studio.light(shading::studio_environment(128));
    Scene scene;
    add_model(scene, *model, gpu_model);
    scene.environment = &light;
    scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
    Perspective lens;
    lens.fov = 0.5F;
    lens.aspect = 4.0F / 3.0F;
    int count = 0;
    // Views under the casing's flange and over the bearings.
    for (const auto& [from, to] : {std::pair{glm::vec3(-0.3F, 0.12F, 0.2F), glm::vec3(-0.14F, 0.02F, 0.06F)},
                                   {glm::vec3(0.3F, 0.35F, 0.55F), glm::vec3(0.175F, 0.03F, 0.05F)}}) {
        const Eye eye = make_eye(from, to, lens);
        Picture picture = studio.shoot(scene, eye, small);
        const Picture reference = studio.shoot(scene, eye, large);
        const int here = sparks(picture, reference);
        count += here;
        // Negative control: one bright pixel is found.
        picture.rgba[4 * (40 * small.width + 50) + 1] = 255;
        CHECK(sparks(picture, reference) == here + 1);
    }
    CHECK(count <= 8);
}
