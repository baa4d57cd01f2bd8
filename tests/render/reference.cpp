// The renderer compared with the path tracer: the same model, light and camera.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>

#include "engine/assets/gltf.hpp"
#include "tests/render/support.hpp"
#include "tools/verify/imagediff/flip.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/render.hpp"

namespace render_reference_test {

using namespace bolt;

namespace {

constexpr int width = 144, height = 108;
constexpr float fov = 0.6F;
constexpr glm::vec3 grey(0.32F, 0.34F, 0.36F);

imagediff::RgbImage traced(const assets::Model& model, const glm::vec3& eye, const glm::vec3& target,
                           std::vector<float>& depth) {
    const auto scene = pathtrace::TracedScene::build(model, {});
    REQUIRE(scene.has_value());
    pathtrace::PinholeCamera camera;
    camera.eye = eye;
    camera.target = target;
    camera.fov = fov;
    camera.width = width;
    camera.height = height;
    pathtrace::PathTraceSettings settings;
    settings.samples = 48;
    settings.background = grey;
    const std::vector<glm::vec3> radiance =
        pathtrace::render(*scene, pathtrace::Environment(shading::studio_environment(128)), camera, settings);
    depth = pathtrace::depth(*scene, camera);
    return {width, height, pathtrace::to_srgb8(radiance, 1.0F)};
}

imagediff::RgbImage rendered(const assets::Model& model, const glm::vec3& eye, const glm::vec3& target) {
    test::Studio studio;
    const render::GpuModel gpu_model = studio.upload(model);
    const render::EnvironmentLight light = studio.light(shading::studio_environment(128));
    render::Scene scene;
    render::add_model(scene, model, gpu_model);
    scene.environment = &light;
    scene.background = glm::vec4(grey, 1.0F);
    scene.occlusion_radius = 0.012F;
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = static_cast<float>(width) / static_cast<float>(height);
    const render::Picture picture = studio.shoot(scene, render::make_eye(eye, target, lens), {width, height});
    imagediff::RgbImage rgb{width, height, {}};
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        rgb.rgb.insert(rgb.rgb.end(), &picture.rgba[i], &picture.rgba[i] + 3);
    return rgb;
}

double difference_on_the_model(const imagediff::RgbImage& a, const imagediff::RgbImage& b,
                               const std::vector<float>& depth) {
    const std::vector<float> values = imagediff::flip(a, b);
    std::vector<float> model;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (depth[i] > 0.0F) model.push_back(values[i]);
    REQUIRE(model.size() > values.size() / 5);
    return imagediff::mean(model);
}

}  // namespace

TEST_CASE("Reference: paint, zinc and steel of the M8 cover agree with the path tracer") {
    const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
    REQUIRE(folder != nullptr);
    const std::filesystem::path content(folder);
    const auto model = assets::read_gltf(content / "assemblies/cover-m8/cover-m8.glb");
    REQUIRE(model.has_value());
    const glm::vec3 eye(0.13F, 0.14F, 0.2F), target(0.0F, -0.01F, 0.0F);
    std::vector<float> depth;
    const imagediff::RgbImage reference = traced(*model, eye, target, depth);
    const imagediff::RgbImage picture = rendered(*model, eye, target);
    const double difference = difference_on_the_model(reference, picture, depth);
    CAPTURE(difference);
    CHECK(imagediff::mean(imagediff::flip(reference, picture)) < 0.11);
    // The limit is larger without the background: the renderer has indirect light only from near parts and
    // shows the grain of brushed steel only in light from lamps.
    CHECK(difference < 0.32);

    // Negative control: another paint or a shifted target is detected.
    assets::Model repainted = *model;
    for (assets::Material& material : repainted.materials) material.base_color = {0.5F, 0.1F, 0.1F, 1.0F};
    CHECK(difference_on_the_model(reference, rendered(repainted, eye, target), depth) > 1.2 * difference);
    CHECK(difference_on_the_model(reference, rendered(*model, eye, target + glm::vec3(0.02F, 0, 0)), depth) >
          1.2 * difference);
}

}  // namespace render_reference_test
