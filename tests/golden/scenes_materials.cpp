// Golden pictures of materials.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/golden/golden_studio.hpp"

using namespace bolt;
using namespace bolt::render;
using namespace bolt::test;

namespace {

// Rows of five balls, from smooth on the left to rough on the right.
constexpr int columns = 5;

std::vector<assets::Material> rows_of_materials() {
    std::vector<assets::Material> all;
    for (int row = 0; row < 4; ++row) {
        for (int i = 0; i < columns; ++i) {
            const float part = static_cast<float>(i) / (columns - 1);
            assets::Material m =
                row < 1 ? metal({0.9F, 0.72F, 0.45F}, part) : paint({0.12F, 0.3F, 0.42F}, part);
            if (row == 2) {  // coat over rough paint
                m.roughness = 0.8F;
                m.clearcoat = 1.0F;
                m.clearcoat_roughness = 0.5F * part;
            }
            if (row == 3) {  // brushed steel, rotated from ball to ball
                m = metal({0.56F, 0.57F, 0.58F}, 0.3F);
                m.anisotropy = 0.25F + 0.7F * part;
                m.anisotropy_rotation = 0.8F * part;
            }
            all.push_back(m);
        }
    }
    return all;
}

// A normal map of domes on a grid.
glm::vec4 domes(int x, int y) {
    const glm::vec2 p = (glm::vec2(x % 16, y % 16) - 7.5F) / 8.0F;
    const float r2 = glm::dot(p, p);
    const glm::vec3 n = r2 < 0.8F ? glm::normalize(glm::vec3(p.x, -p.y, 1.2F)) : glm::vec3(0, 0, 1);
    return {0.5F * n + 0.5F, 1.0F};
}

// A texture that shows its orientation: tiles, a red corner at the top left, a green one at the top right.
glm::vec4 tiles(int x, int y) {
    if (x < 16 && y < 16) return {0.8F, 0.1F, 0.1F, 1.0F};
    if (x >= 48 && y < 16) return {0.1F, 0.6F, 0.1F, 1.0F};
    const float grey = (x / 8 + y / 8) % 2 == 0 ? 0.85F : 0.55F;
    return {grey, grey, 0.9F * grey, 1.0F};
}

// Adds all maps to the first material. Occlusion in red, roughness in green, metallic in blue, as in glTF.
void texture_all(assets::Model& model) {
    assets::Material& m = model.materials[0];
    m.base_color_texture.texture = add_texture(model, 64, tiles);
    m.normal_texture.texture = add_texture(model, 64, domes);
    const int packed = add_texture(model, 64, [](int x, int y) {
        const bool stripe = y / 8 % 4 == 3;
        return glm::vec4(x < 8 ? 0.2F : 1.0F, stripe ? 0.25F : 0.7F, stripe ? 1.0F : 0.0F, 1.0F);
    });
    m.metallic_roughness_texture.texture = m.occlusion_texture.texture = packed;
    m.metallic = m.roughness = 1.0F;
    m.emissive = {1.0F, 0.5F, 0.1F};
    m.emissive_texture.texture = add_texture(model, 64, [](int x, int y) {
        const bool lit = x > 40 && x < 56 && y > 40 && y < 56;
        return lit ? glm::vec4(1.0F) : glm::vec4(0, 0, 0, 1);
    });
}

}  // namespace

TEST_CASE("Golden: metal, paint, clear coat and brushed steel from smooth to rough") {
    GoldenStudio golden;
    const std::vector<assets::Material> materials = rows_of_materials();
    assets::Model model = globe(materials[0]);
    model.materials = materials;
    const assets::Primitive ball = model.meshes[0].primitives[0];
    model.meshes.clear();
    for (int i = 0; i < static_cast<int>(materials.size()); ++i) {
        model.meshes.push_back({"ball", {ball}, {}});
        model.meshes.back().primitives[0].material = i;
    }
    const GpuModel gpu_model = golden.studio.upload(model);
    Scene scene = golden.scene();
    for (int i = 0; i < static_cast<int>(materials.size()); ++i) {
        Object object;
        object.model = &gpu_model;
        object.mesh = static_cast<std::uint32_t>(i);
        object.world = at(
            {2.1F * static_cast<float>(i % columns - 2), 2.1F * (1.5F - static_cast<float>(i / columns)), 0});
        scene.objects.push_back(object);
    }
    scene.lights.push_back(lamp({-0.5F, -0.8F, -0.6F}, 1.5F));
    scene.lights.back().casts_shadow = false;
    golden.shoot("materials", scene, eye_at({0, 0, 30}, {0, 0, 0}, 0.29F, 1.25F), {250, 200});
}

TEST_CASE("Golden: all five maps, with and without tangents, rotated and repeated") {
    GoldenStudio golden;
    assets::Model with = cube(paint(glm::vec3(1.0F))), without = cube(paint(glm::vec3(1.0F)), false),
                  small = globe(paint(glm::vec3(1.0F)));
    for (assets::Model* model : {&with, &without, &small}) texture_all(*model);
    for (assets::TextureRef* ref :
         {&small.materials[0].base_color_texture, &small.materials[0].normal_texture,
          &small.materials[0].metallic_roughness_texture}) {
        ref->scale = {8, 4};
        ref->rotation = 0.3F;
        ref->offset = {0.1F, 0.2F};
    }
    small.materials[0].emissive = glm::vec3(0.0F);
    const GpuModel a = golden.studio.upload(with), b = golden.studio.upload(without),
                   c = golden.studio.upload(small);
    Scene scene = golden.scene();
    const glm::mat4 turned(glm::vec4(0.8F, 0, -0.6F, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0.6F, 0, 0.8F, 0),
                           glm::vec4(-1.6F, 0, 0, 1));
    add_model(scene, with, a, turned);
    add_model(scene, without, b, at({3.2F, 0, 0}) * turned);
    add_model(scene, small, c, at({0, 2.2F, -1.5F}));
    scene.lights.push_back(lamp({-0.5F, -0.7F, -0.8F}, 1.2F));
    scene.lights.back().casts_shadow = false;
    golden.shoot("maps", scene, eye_at({0, 2.5F, 9}, {0, 0.5F, 0}));
}

TEST_CASE("Golden: alpha mask and blend, and vertex colours") {
    GoldenStudio golden;
    assets::Model mask = plate(paint({0.7F, 0.5F, 0.2F}));
    mask.meshes[0].primitives[0].texcoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    mask.materials[0].base_color_texture.texture = add_texture(mask, 64, [](int x, int y) {
        const glm::vec2 p = (glm::vec2(x % 16, y % 16) - 7.5F) / 8.0F;
        return glm::vec4(1, 1, 1, std::clamp(3.0F * (glm::length(p) - 0.6F) + 0.5F, 0.0F, 1.0F));
    });
    mask.materials[0].alpha_mode = assets::AlphaMode::mask;
    mask.materials[0].double_sided = true;
    assets::Model glass = plate(paint({0.2F, 0.5F, 0.9F}, 0.1F));
    glass.materials[0].base_color.a = 0.4F;
    glass.materials[0].alpha_mode = assets::AlphaMode::blend;
    glass.materials[0].double_sided = true;
    assets::Model red = glass;
    red.materials[0].base_color = {0.9F, 0.15F, 0.1F, 0.6F};
    assets::Model colors = plate(paint(glm::vec3(1.0F)));
    colors.meshes[0].primitives[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {1, 1, 1, 1}};
    const GpuModel a = golden.studio.upload(mask), b = golden.studio.upload(glass),
                   c = golden.studio.upload(red), d = golden.studio.upload(colors);
    const glm::mat4 upright(glm::vec4(1, 0, 0, 0), glm::vec4(0, 0, 1, 0), glm::vec4(0, -1, 0, 0),
                            glm::vec4(0, 0, 0, 1));
    Scene scene = golden.scene();
    // Nearer panes are listed first: the renderer has to sort blended parts.
    add_model(scene, red, c, at({0.9F, 0.2F, 1.5F}, glm::vec3(0.8F)) * upright);
    add_model(scene, glass, b, at({0.1F, 0.6F, 0.6F}, glm::vec3(0.8F)) * upright);
    add_model(scene, mask, a, at({-1.1F, 0.4F, 1.0F}, glm::vec3(0.9F)) * upright);
    add_model(scene, colors, d, at({0, -0.6F, 0}, glm::vec3(2.2F)));
    golden.shoot("alpha", scene, eye_at({0.8F, 2.2F, 7.5F}, {0, 0.1F, 0}));
}
