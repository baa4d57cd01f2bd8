// Compares the renderer's depth and silhouettes with ray casting.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "engine/assets/gltf.hpp"
#include "engine/gpu/resources.hpp"
#include "tests/render/support.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/scene.hpp"

namespace render_depth_test {

using namespace bolt;

namespace {

constexpr VkExtent2D extent{320, 240};
constexpr float znear = 0.1F, zfar = 5.0F;
// The first of the four standard sample locations (Vulkan specification, 25.3.1 Multisampling).
constexpr glm::vec2 first_sample(0.375F, 0.125F);

struct CameraPose {
    std::string name;
    glm::vec3 eye{0.0F}, target{0.0F};
    float fov = 0.0F;
};

struct Comparison {
    double median = 0.0, p99 = 0.0;  // m
    double silhouette = 0.0;         // fraction of pixels covered in only one of the pictures
    double covered = 0.0;            // fraction of pixels covered in both
};

// Distances along the view direction in metres; 0: background.
std::vector<float> rendered(test::Studio& studio, const render::Scene& scene, const CameraPose& from) {
    render::Perspective lens;
    lens.fov = from.fov;
    lens.aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    lens.znear = znear;
    lens.zfar = zfar;
    (void)studio.shoot(scene, render::make_eye(from.eye, from.target, lens), extent);
    const render::ImageLayer layer = studio.renderer().depth(0);
    REQUIRE(layer.image != nullptr);
    const auto bytes = gpu::download_image(studio.device(), *layer.image, gpu::ResourceUse::transfer_from,
                                           sizeof(float), 0, layer.layer);
    REQUIRE(bytes.has_value());
    std::vector<float> depth(bytes->size() / sizeof(float));
    std::memcpy(depth.data(), bytes->data(), bytes->size());
    // depth = (near · far / z − near) / (far − near)
    for (float& d : depth) d = d > 0.0F ? znear * zfar / (d * (zfar - znear) + znear) : 0.0F;
    return depth;
}

std::vector<float> traced(const pathtrace::TracedScene& scene, const CameraPose& from) {
    pathtrace::PinholeCamera camera;
    camera.eye = from.eye;
    camera.target = from.target;
    camera.fov = from.fov;
    camera.width = static_cast<int>(extent.width);
    camera.height = static_cast<int>(extent.height);
    const glm::vec3 forward = glm::normalize(from.target - from.eye);
    std::vector<float> depth;
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const glm::vec3 ray = pathtrace::ray_direction(camera, glm::vec2(x, y) + first_sample);
            const auto hit = scene.cast(from.eye, ray);
            depth.push_back(hit ? hit->distance * glm::dot(ray, forward) : 0.0F);
        }
    return depth;
}

Comparison compare(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    std::vector<double> errors;
    std::size_t disagree = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool here = a[i] > 0.0F, there = b[i] > 0.0F;
        if (here != there) ++disagree;
        if (here && there) errors.push_back(std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    }
    REQUIRE(errors.size() > a.size() / 5);
    std::sort(errors.begin(), errors.end());
    const auto all = static_cast<double>(a.size());
    return {errors[errors.size() / 2], errors[errors.size() * 99 / 100], static_cast<double>(disagree) / all,
            static_cast<double>(errors.size()) / all};
}

render::RendererOptions keeping_depth() {
    render::RendererOptions options;
    options.keep_depth = true;
    return options;
}

}  // namespace

TEST_CASE(
    "Depth: agrees with ray casting, the ZQ350 within 0.1 mm and its silhouettes within one pixel per "
    "thousand") {
    const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(folder != nullptr);
    const auto model = assets::read_gltf(std::filesystem::path(folder) / "assemblies/zq350/zq350.glb");
    REQUIRE(model.has_value());
    const auto rays = pathtrace::TracedScene::build(*model, {});
    REQUIRE(rays.has_value());
    test::Studio studio(keeping_depth());
    const render::GpuModel gpu_model = studio.upload(*model);
    render::Scene scene;
    render::add_model(scene, *model, gpu_model);

    const glm::vec3 middle = 0.5F * (rays->low() + rays->high()), size = rays->high() - rays->low();
    const CameraPose poses[] = {
        {"the whole, from the front", middle + glm::vec3(0.55F, 0.5F, 1.0F), middle, 0.6F},
        {"the whole, from behind", middle + glm::vec3(-0.8F, 0.9F, -0.7F), middle, 0.6F},
        {"near a corner of the lid", middle + size * glm::vec3(0.75F, 0.8F, 1.1F),
         middle + size * glm::vec3(0.28F, 0.22F, 0.2F), 0.5F}};
    for (const CameraPose& from : poses) {
        CAPTURE(from.name);
        const std::vector<float> expected = traced(*rays, from), seen = rendered(studio, scene, from);
        const Comparison result = compare(seen, expected);
        CAPTURE(result.covered);
        CHECK(result.median < 1e-4);
        CHECK(result.p99 < 1e-3);
        // Rasterisers snap vertices to a grid of 1/256 pixel or finer, which moves silhouettes by at most
        // that much. A few per cent of the pixels are on a silhouette, and about one in 256 of those changes
        // sides.
        CHECK(result.silhouette < 1e-3);

        // Negative control: an eye 2 mm aside or 1 mm nearer, or a shift by a pixel, is detected.
        CameraPose aside = from;
        aside.eye += glm::vec3(0.002F, 0.0F, 0.0F);
        aside.target += glm::vec3(0.002F, 0.0F, 0.0F);
        CHECK(compare(rendered(studio, scene, aside), expected).silhouette > 1e-3);
        CameraPose nearer = from;
        nearer.eye += 1e-3F * glm::normalize(from.target - from.eye);
        CHECK(compare(rendered(studio, scene, nearer), expected).median > 5e-4);
        std::vector<float> shifted = seen;
        std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
        CHECK(compare(shifted, expected).silhouette > 1e-3);
    }
}

}  // namespace render_depth_test
