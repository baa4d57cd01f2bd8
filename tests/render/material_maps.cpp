// Material maps, compared with constant materials and with the path tracer, on a plate under one lamp, where
// both use the same closed formulas.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/base/random.hpp"
#include "tests/render/support.hpp"
#include "tools/verify/pathtrace/camera.hpp"
#include "tools/verify/pathtrace/render.hpp"

using namespace bolt;

namespace {

constexpr int width = 96, height = 72;
constexpr float fov = 0.5F;
constexpr glm::vec3 eye(0.1F, 1.9F, 1.3F), target(0.0F, 0.0F, 0.05F);

// A small texture of smoothly varying colours; `even` gives one colour.
assets::Bitmap texels(std::uint32_t seed, bool even = false) {
    Random random(seed);
    assets::Bitmap image;
    image.width = image.height = 4;
    image.channels = 4;
    for (std::size_t i = 0; i < 64; ++i)
        image.pixels.push_back(even && i >= 4 ? image.pixels[i - 4]
                                              : static_cast<std::uint8_t>(random.uniform(60.0, 255.0)));
    return image;
}

// A normal map with slightly tilted normals.
assets::Bitmap bumps(std::uint32_t seed) {
    assets::Bitmap image = texels(seed);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        for (std::size_t c = 0; c < 2; ++c)
            image.pixels[i + c] = static_cast<std::uint8_t>(128 + (image.pixels[i + c] - 158) / 3);
        image.pixels[i + 2] = 250;
    }
    return image;
}

// Grain directions in all quadrants; blue: strength.
assets::Bitmap grains(std::uint32_t seed) {
    assets::Bitmap image = texels(seed);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const double angle = 0.3 + 0.02 * static_cast<double>(i);
        image.pixels[i] = static_cast<std::uint8_t>(127.5 + 127.0 * std::cos(angle));
        image.pixels[i + 1] = static_cast<std::uint8_t>(127.5 + 127.0 * std::sin(angle));
    }
    return image;
}

// The plate under a lamp, with two sets of texture coordinates, the second rotated and larger.
assets::Model plate(const assets::Material& material, assets::Texture texture, const assets::Bitmap& image,
                    bool tangents = true) {
    assets::Model model = test::plate(material);
    texture.image = 0;
    model.textures = {texture};
    model.images = {image};
    assets::Primitive& p = model.meshes[0].primitives[0];
    for (const glm::vec3& at : p.positions) {
        p.texcoords[0].emplace_back(0.5F + 0.5F * at.x, 0.5F + 0.5F * at.z);
        p.texcoords[1].emplace_back(0.2F + at.z, 0.4F - 0.7F * at.x);
        if (tangents) p.tangents.emplace_back(1, 0, 0, 1);
    }
    model.lights = {{.type = assets::LightType::directional, .intensity = 1.3F}};
    const glm::mat4 sun = glm::inverse(glm::lookAt(glm::vec3(0), glm::vec3(0.1F, -1.0F, 0.7F), {0, 1, 0}));
    assets::Node lamp;
    lamp.rotation = glm::quat_cast(sun);
    lamp.light = 0;
    model.nodes.push_back(lamp);
    model.roots.push_back(1);
    return model;
}

render::Picture rendered(test::Studio& studio, const assets::Model& model) {
    const render::GpuModel gpu_model = studio.upload(model);
    render::Scene scene;
    render::add_model(scene, model, gpu_model);
    render::add_lights(scene, model);
    render::Perspective lens;
    lens.fov = fov;
    lens.aspect = static_cast<float>(width) / static_cast<float>(height);
    return studio.shoot(scene, render::make_eye(eye, target, lens), {width, height});
}

std::vector<std::uint8_t> traced(const assets::Model& model) {
    const auto scene = pathtrace::TracedScene::build(model, {});
    REQUIRE(scene.has_value());
    pathtrace::PinholeCamera camera{eye, target, fov, width, height};
    pathtrace::PathTraceSettings settings;
    settings.samples = 16;
    return pathtrace::to_srgb8(pathtrace::render(*scene, pathtrace::Environment(), camera, settings), 1.0F);
}

// Returns the mean difference over all channels, in steps of 1/255.
double difference(const render::Picture& picture, const std::vector<std::uint8_t>& rgb) {
    REQUIRE(picture.rgba.size() / 4 == rgb.size() / 3);
    double sum = 0.0;
    for (std::size_t i = 0; i < rgb.size(); ++i)
        sum += std::abs(int{picture.rgba[i / 3 * 4 + i % 3]} - int{rgb[i]});
    return sum / static_cast<double>(rgb.size());
}

double mean_difference(const render::Picture& a, const render::Picture& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    return sum * 4.0 / 3.0 / static_cast<double>(a.rgba.size());
}

assets::Material base_material(float metallic, float roughness) {
    assets::Material m;
    m.base_color = {0.5F, 0.4F, 0.3F, 1.0F};
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

// A material with one map, and the member that refers to the map.
struct Case {
    std::string name;
    assets::Material material;
    assets::Bitmap image;
    assets::TextureRef assets::Material::*map;
};

std::vector<Case> cases() {
    using M = assets::Material;
    std::vector<Case> all;
    const auto add = [&](const char* name, const M& m, const assets::Bitmap& image, auto map) {
        all.push_back({name, m, image, map});
        (all.back().material.*map).texture = 0;
    };
    M shiny = base_material(0.0F, 0.35F);
    shiny.ior = 1.9F;
    add("specular", shiny, texels(1), &M::specular_texture);
    shiny.specular_color = {1.0F, 0.8F, 0.9F};
    add("specular colour", shiny, texels(2), &M::specular_color_texture);
    M coated = base_material(0.3F, 0.8F);
    coated.clearcoat = 1.0F;
    coated.clearcoat_roughness = 0.35F;
    add("coat", coated, texels(3), &M::clearcoat_texture);
    coated.clearcoat_roughness = 0.7F;
    add("coat roughness", coated, texels(4), &M::clearcoat_roughness_texture);
    coated.clearcoat_roughness = 0.35F;
    add("coat normal", coated, bumps(5), &M::clearcoat_normal_texture);
    M brushed = base_material(1.0F, 0.35F);
    brushed.anisotropy = 0.9F;
    brushed.anisotropy_rotation = 0.4F;
    add("anisotropy", brushed, grains(6), &M::anisotropy_texture);
    add("base colour", base_material(0.0F, 0.6F), texels(7), &M::base_color_texture);
    add("metallic and roughness", base_material(1.0F, 0.8F), texels(8), &M::metallic_roughness_texture);
    add("normal", base_material(0.5F, 0.5F), bumps(9), &M::normal_texture);
    return all;
}

}  // namespace

TEST_CASE("Material maps: every map has an effect and agrees with the path tracer") {
    test::Studio studio;
    for (const Case& one : cases()) {
        CAPTURE(one.name);
        for (const bool second : {false, true}) {
            CAPTURE(second);
            assets::Material material = one.material;
            (material.*one.map).texcoord = second ? 1 : 0;
            // The mesh's tangents belong to the first set.
            const assets::Model model = plate(material, {}, one.image);
            const render::Picture picture = rendered(studio, model);
            CHECK(difference(picture, traced(model)) < 1.6);
            material.*one.map = {};
            CHECK(mean_difference(picture, rendered(studio, plate(material, {}, one.image))) > 5.0);
        }
    }
}

TEST_CASE("Material maps: a mesh without tangents gets tangents from its texture coordinates") {
    test::Studio studio;
    for (const Case& one : cases()) {
        CAPTURE(one.name);
        const render::Picture with = rendered(studio, plate(one.material, {}, one.image, true));
        const assets::Model model = plate(one.material, {}, one.image, false);
        const render::Picture without = rendered(studio, model);
        CHECK(mean_difference(with, without) < 0.5);
        CHECK(difference(without, traced(model)) < 1.6);
    }
    // Mirrored coordinates keep the texture's up direction.
    for (const std::string name : {"normal", "anisotropy", "coat normal"}) {
        CAPTURE(name);
        for (const Case& one : cases()) {
            if (one.name != name) continue;
            assets::Model given = plate(one.material, {}, one.image, true);
            assets::Primitive& p = given.meshes[0].primitives[0];
            for (glm::vec2& uv : p.texcoords[0]) uv.x = 1.0F - uv.x;
            p.tangents.assign(4, {-1, 0, 0, -1});
            assets::Model made = given;
            made.meshes[0].primitives[0].tangents.clear();
            const render::Picture picture = rendered(studio, given);
            CHECK(mean_difference(picture, rendered(studio, made)) < 0.5);
            CHECK(difference(picture, traced(given)) < 1.6);
            CHECK(difference(picture, traced(made)) < 1.6);
        }
    }
}

TEST_CASE("Material maps: a map with one value equals a constant") {
    test::Studio studio;
    const assets::Bitmap even = texels(10, true);
    const auto value = [&](std::size_t c) { return static_cast<float>(even.pixels[c]) / 255.0F; };
    const auto difference_to_constant = [&](assets::Material with, assets::TextureRef assets::Material::*map,
                                            auto set) {
        (with.*map).texture = 0;
        assets::Material without = with;
        without.*map = {};
        set(without);
        const render::Picture a = rendered(studio, plate(with, {}, even)),
                              b = rendered(studio, plate(without, {}, even));
        return test::largest_difference(a, b);
    };
    using M = assets::Material;
    M m = base_material(0.0F, 0.35F);
    m.ior = 1.8F;
    CHECK(difference_to_constant(m, &M::specular_texture, [&](M& n) { n.specular *= value(3); }) <= 2);
    m.clearcoat = 0.9F;
    m.clearcoat_roughness = 0.3F;
    CHECK(difference_to_constant(m, &M::clearcoat_texture, [&](M& n) { n.clearcoat *= value(0); }) <= 2);
    CHECK(difference_to_constant(m, &M::clearcoat_roughness_texture,
                                 [&](M& n) { n.clearcoat_roughness *= value(1); }) <= 2);
    // Negative control.
    CHECK(difference_to_constant(m, &M::clearcoat_texture, [&](M& n) { n.clearcoat *= 0.2F; }) > 4);
    m = base_material(1.0F, 0.35F);
    m.anisotropy = 0.9F;
    CHECK(difference_to_constant(m, &M::anisotropy_texture, [&](M& n) {
              n.anisotropy *= value(2);
              n.anisotropy_rotation += std::atan2(value(1) * 2.0F - 1.0F, value(0) * 2.0F - 1.0F);
          }) <= 2);
}

TEST_CASE("Material maps: the two directions of a texture wrap independently") {
    test::Studio studio;
    using assets::Wrap;
    assets::Material m = base_material(0.0F, 0.8F);
    m.base_color_texture = {.texture = 0, .offset = {-0.7F, 0.6F}, .rotation = 0.2F, .scale = {2.3F, 1.9F}};
    std::vector<render::Picture> pictures;
    for (const Wrap s : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const Wrap t : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
            for (const auto filter : {assets::Filter::linear, assets::Filter::nearest}) {
                CAPTURE(static_cast<int>(s));
                CAPTURE(static_cast<int>(t));
                const assets::Model model =
                    plate(m, {.mag = filter, .mipmapped = false, .wrap_s = s, .wrap_t = t}, texels(11));
                pictures.push_back(rendered(studio, model));
                CHECK(difference(pictures.back(), traced(model)) < 2.5);
                for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
                    CHECK(mean_difference(pictures[i], pictures.back()) > 3.5);
            }
}
