// Tests of whole images against closed forms.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/assets/image.hpp"
#include "tests/pathtrace/about.hpp"
#include "tests/pathtrace/shapes.hpp"
#include "tools/verify/pathtrace/flatten.hpp"
#include "tools/verify/pathtrace/render.hpp"

namespace pathtrace_picture_test {

using namespace bolt;
using namespace bolt::pathtrace;

namespace {

constexpr float pi = std::numbers::pi_v<float>;

TracedScene build(const assets::Model& model, const TracedSceneOptions& options = {}) {
    auto scene = TracedScene::build(model, options);
    REQUIRE_MESSAGE(scene, scene.error().message());
    return std::move(*scene);
}

glm::vec3 mean(const std::vector<glm::vec3>& image) {
    glm::dvec3 sum(0.0);
    for (const glm::vec3& value : image) sum += glm::dvec3(value);
    return glm::vec3(sum / static_cast<double>(image.size()));
}

// A camera so distant and narrow that its rays are parallel within a thousandth.
PinholeCamera telescope(int size) {
    return {
        .eye = {0.0F, 0.0F, 1000.0F}, .fov = 2.0F * std::atan(1.1F / 1000.0F), .width = size, .height = size};
}

// A sphere lit by a sun at the angle `phase` (rad) from the viewer.
assets::Model under_sun(const assets::Material& material, float phase, float illuminance) {
    assets::Model model = single(sphere(256, 128), material);
    model.lights = {{.name = "sun", .type = assets::LightType::directional, .intensity = illuminance}};
    model.nodes.push_back(
        {.name = "sun", .rotation = glm::angleAxis(phase, glm::vec3(0.0F, 1.0F, 0.0F)), .light = 0});
    model.roots.push_back(1);
    return model;
}

}  // namespace

TEST_CASE("Path tracer: a white sphere is invisible before white surroundings (white furnace)") {
    for (const float roughness : {0.1F, 0.5F, 1.0F}) {
        for (const float metallic : {0.0F, 1.0F}) {
            for (const float coat : {0.0F, 1.0F}) {
                assets::Material material;
                material.metallic = metallic;
                material.roughness = roughness;
                material.clearcoat = coat;
                material.clearcoat_roughness = 0.1F;
                const TracedScene scene = build(single(sphere(96, 48), material));
                const Environment environment(constant_environment(glm::vec3(1.0F)));
                const auto image = render(scene, environment, telescope(24), {.samples = 64});
                CAPTURE(roughness);
                CAPTURE(metallic);
                CAPTURE(coat);
                CHECK(mean(image).g == about(1.0F).epsilon(0.01));
            }
        }
    }
}

TEST_CASE("Path tracer: a matte sphere under the sun follows Lambert's law and Lambert's phase curve") {
    const glm::vec3 color(0.8F, 0.5F, 0.2F);
    const Environment dark;
    for (const float phase : {0.0F, 0.7F, pi / 2.0F, 2.2F}) {
        const TracedScene scene = build(under_sun(matte(color), phase, 3.0F));
        const PinholeCamera camera = telescope(64);
        const auto image = render(scene, dark, camera, {.samples = 16});
        const glm::vec3 towards_sun(std::sin(phase), 0.0F, std::cos(phase));
        CAPTURE(phase);
        for (int y = 0; y < 64; ++y) {
            for (int x = 0; x < 64; ++x) {
                const glm::vec2 position((static_cast<float>(x) - 31.5F) * 2.2F / 64.0F,
                                         (31.5F - static_cast<float>(y)) * 2.2F / 64.0F);
                const float r2 = glm::dot(position, position);
                if (r2 > 0.8F) continue;  // the rim, where a pixel covers many angles
                const glm::vec3 normal(position, std::sqrt(1.0F - r2));
                const float cosine = glm::dot(normal, towards_sun);
                if (std::abs(cosine) < 0.1F) continue;  // the terminator crosses the pixel
                const float expected = std::max(0.0F, cosine) * 3.0F * color.g / pi;
                const float found = image[static_cast<std::size_t>(y * 64 + x)].g;
                CHECK(std::abs(found - expected) < 0.012F * 3.0F * color.g / pi);
            }
        }
        // J. H. Lambert, Photometria, 1760: 2/3 ρ E (sin φ + (π − φ) cos φ) / π of the disc's light.
        const float total = mean(image).r * 2.2F * 2.2F;
        const float expected =
            2.0F / 3.0F * color.r * 3.0F * (std::sin(phase) + (pi - phase) * std::cos(phase)) / pi;
        CHECK(total == about(expected).epsilon(0.01));
    }
}

TEST_CASE("Path tracer: the middle of a rough metal sphere under the sun follows the lighting model") {
    assets::Material metal;
    metal.base_color = {0.9F, 0.6F, 0.3F, 1.0F};
    metal.roughness = 0.6F;
    const float phase = 0.8F;
    const TracedScene scene = build(under_sun(metal, phase, 2.0F));
    PinholeCamera camera = telescope(3);
    camera.fov *= 0.01F;
    const auto image = render(scene, Environment(), camera, {.samples = 4});
    ShadingPoint surface;
    surface.base_color = metal.base_color;
    surface.metallic = 1.0F;
    surface.alpha = glm::vec2(0.36F);
    const glm::vec3 expected =
        2.0F * Bsdf(surface, {0, 0, 1}).evaluate({std::sin(phase), 0.0F, std::cos(phase)}).value;
    for (int c = 0; c < 3; ++c) CHECK(image[4][c] == about(expected[c]).epsilon(0.01));
}

TEST_CASE("Path tracer: point and spot lights fall off with the square of the distance, range and cone") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    model.lights = {{.intensity = 12.0F}};
    model.nodes.push_back({.name = "lamp", .translation = {0.0F, 0.0F, 2.0F}, .light = 0});
    model.roots.push_back(1);
    PinholeCamera camera{.eye = {0.0F, 0.0F, 3.0F}, .fov = 1e-5F, .width = 1, .height = 1};
    const auto rendered = [&] { return render(build(model), Environment(), camera, {.samples = 1})[0].r; };
    CHECK(rendered() == about(12.0F / 4.0F / pi).epsilon(1e-3));
    model.lights[0].range = 4.0F;
    CHECK(rendered() == about(12.0F / 4.0F / pi * (1.0F - 1.0F / 16.0F)).epsilon(1e-3));
    model.lights[0] = {
        .type = assets::LightType::spot, .intensity = 12.0F, .inner_cone = 0.2F, .outer_cone = 0.4F};
    CHECK(rendered() == about(12.0F / 4.0F / pi).epsilon(1e-3));
    model.nodes[1].rotation = glm::angleAxis(0.3F, glm::vec3(1.0F, 0.0F, 0.0F));
    const float part = (std::cos(0.3F) - std::cos(0.4F)) / (std::cos(0.2F) - std::cos(0.4F));
    CHECK(rendered() == about(12.0F / 4.0F / pi * part * part).epsilon(1e-3));
    model.nodes[1].rotation = glm::angleAxis(0.5F, glm::vec3(1.0F, 0.0F, 0.0F));
    CHECK(rendered() == 0.0F);
}

TEST_CASE("Path tracer: a shadow is black; a transparent object casts a partial one") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    model.lights = {{.type = assets::LightType::directional, .intensity = pi}};
    model.nodes.push_back({.name = "sun", .light = 0});
    model.roots.push_back(1);
    model.materials.push_back(matte(glm::vec3(0.0F)));
    model.meshes.push_back(model.meshes[0]);
    model.meshes[1].primitives[0].material = 1;
    model.nodes.push_back({.name = "screen", .translation = {0.0F, 0.0F, 1.0F}, .mesh = 1});
    model.roots.push_back(2);
    const PinholeCamera camera{.eye = {0.0F, 0.0F, 0.5F}, .fov = 0.001F, .width = 1, .height = 1};
    const auto rendered = [&](int samples) {
        return render(build(model), Environment(), camera, {.samples = samples})[0].r;
    };
    CHECK(rendered(1) == 0.0F);
    model.materials[1].alpha_mode = assets::AlphaMode::blend;
    model.materials[1].base_color.a = 0.25F;
    CHECK(rendered(1) == about(0.75F).epsilon(1e-4));
    model.materials[1].alpha_mode = assets::AlphaMode::mask;
    CHECK(rendered(1) == about(1.0F).epsilon(1e-4));
}

TEST_CASE("Path tracer: the colour under a pixel is that of its texel") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    assets::Bitmap image;
    image.width = 2;
    image.height = 2;
    image.channels = 3;
    image.pixels = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};  // red, green; blue, white
    model.images = {image};
    model.textures = {{.image = 0, .mag = assets::Filter::nearest}};
    model.materials[0].base_color_texture.texture = 0;
    model.lights = {{.type = assets::LightType::directional, .intensity = pi}};
    model.nodes.push_back({.name = "sun", .light = 0});
    model.roots.push_back(1);
    const PinholeCamera camera{
        .eye = {0.0F, 0.0F, 5.0F}, .fov = 2.0F * std::atan(0.2F), .width = 2, .height = 2};
    const auto rendered = render(build(model), Environment(), camera, {.samples = 8});
    const glm::vec3 expected[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    for (std::size_t i = 0; i < 4; ++i) CHECK(glm::distance(rendered[i], expected[i]) < 1e-3F);
    model.materials[0].base_color_texture.offset = {0.5F, 0.0F};
    const auto moved = render(build(model), Environment(), camera, {.samples = 8});
    CHECK(glm::distance(moved[0], expected[1]) < 1e-3F);
}

TEST_CASE("Path tracer: the image depends on the seed, not on the number of threads") {
    assets::Material material;
    material.roughness = 0.3F;
    material.clearcoat = 1.0F;
    const TracedScene scene = build(single(sphere(24, 12), material), {.nodes = {}, .floor = true});
    const Environment environment(studio_environment(64));
    const PinholeCamera camera{.eye = {0.0F, 2.0F, 5.0F}, .width = 40, .height = 30};
    const auto one = render(scene, environment, camera, {.samples = 4, .threads = 1});
    for (const std::size_t threads : {2U, 5U}) {
        const auto many = render(scene, environment, camera, {.samples = 4, .threads = threads});
        REQUIRE(many.size() == one.size());
        CHECK(std::memcmp(many.data(), one.data(), one.size() * sizeof(glm::vec3)) == 0);
    }
    CHECK(render(scene, environment, camera, {.samples = 4, .seed = 1}) != one);
}

TEST_CASE("Path tracer: depth is measured along the view direction") {
    const TracedScene scene = build(single(square(), matte(glm::vec3(1.0F))));
    const PinholeCamera camera{
        .eye = {0.1F, 0.2F, 0.7F}, .target = {0.1F, 0.2F, 0.0F}, .width = 8, .height = 6};
    for (const float d : depth(scene, camera)) CHECK(d == about(0.7F).epsilon(1e-5));
}

TEST_CASE("Camera: a framed model is inside the image and fills it") {
    const glm::vec3 low(-0.1F, 0.0F, -0.2F);
    const glm::vec3 high(0.5F, 0.3F, 0.2F);
    PinholeCamera camera{.width = 640, .height = 360};
    camera = frame_box(camera, low, high, {0.5F, 0.4F, 1.0F});
    const glm::vec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
    const glm::vec3 up = glm::cross(right, forward);
    float most = 0.0F;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 p((i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
                          (i & 4) != 0 ? high.z : low.z);
        const glm::vec3 v = p - camera.eye;
        const float half = std::tan(0.5F * camera.fov) * glm::dot(v, forward);
        const float x = std::abs(glm::dot(v, right)) / (half * 640.0F / 360.0F);
        const float y = std::abs(glm::dot(v, up)) / half;
        CHECK(std::max(x, y) <= 1.0F);
        most = std::max({most, x, y});
    }
    CHECK(most > 0.9F);
}

}  // namespace pathtrace_picture_test
