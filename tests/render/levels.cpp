// Levels of detail of a machine: fewer triangles, the same appearance.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "engine/assets/gltf.hpp"
#include "tests/render/support.hpp"
#include "tools/verify/imagediff/flip.hpp"

using namespace bolt;

TEST_CASE("Levels of detail: the ZQ350 with less than half of its triangles looks the same") {
    const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(folder != nullptr);
    const auto model = assets::read_gltf(std::filesystem::path(folder) / "assemblies/zq350/zq350.glb");
    REQUIRE(model.has_value());
    test::Studio all, some({.level_error_px = 0.25F});  // at half size: half a pixel of 1280 × 720
    constexpr VkExtent2D extent{640, 360};
    const auto shoot = [&](test::Studio& studio, const render::UploadOptions& options) {
        const render::GpuModel gpu_model = studio.upload(*model, options);
        const render::EnvironmentLight light = studio.light(shading::studio_environment(128));
        render::Scene scene;
        render::add_model(scene, *model, gpu_model);
        scene.environment = &light;
        scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
        const render::Eye eye =
            render::make_eye({0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0}, {0.698F, 16.0F / 9.0F, 0.05F, 5.0F});
        const render::Picture picture = studio.shoot(scene, eye, extent);
        imagediff::RgbImage rgb{static_cast<int>(extent.width), static_cast<int>(extent.height), {}};
        for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
            rgb.rgb.insert(rgb.rgb.end(), &picture.rgba[i], &picture.rgba[i] + 3);
        return rgb;
    };
    const imagediff::RgbImage fine = shoot(all, {}), coarse = shoot(some, {true});
    CHECK(some.renderer().statistics().triangles * 2 < all.renderer().statistics().triangles);
    CHECK(imagediff::mean(imagediff::flip(fine, coarse)) < 0.01);
}
