// Golden pictures of modified objects: mirrored, stretched, ghosts, tinted, unlit.
#include <doctest/doctest.h>

#include "tests/golden/golden_studio.hpp"

using namespace bolt;
using namespace bolt::render;
using namespace bolt::test;

TEST_CASE("Golden: mirrored and stretched objects, lit from one side") {
    GoldenStudio golden;
    assets::Model block = cube(paint(glm::vec3(1.0F)));
    block.materials[0].base_color_texture.texture = add_texture(block, 64, [](int x, int y) {
        // An F shows the orientation.
        const bool ink = (x >= 16 && x < 26 && y >= 8 && y < 56) || (x >= 16 && x < 48 && y >= 8 && y < 18) ||
                         (x >= 16 && x < 40 && y >= 28 && y < 37);
        return ink ? glm::vec4(0.05F, 0.1F, 0.4F, 1.0F) : glm::vec4(0.8F, 0.75F, 0.6F, 1.0F);
    });
    block.materials[0].normal_texture.texture = add_texture(block, 64, [](int x, int) {
        return glm::vec4(x % 16 < 8 ? 0.7F : 0.3F, 0.5F, 0.9F, 1.0F);  // ribs
    });
    assets::Model ball = globe(metal({0.56F, 0.57F, 0.58F}, 0.35F));
    ball.materials[0].anisotropy = 0.7F;
    const GpuModel a = golden.studio.upload(block), b = golden.studio.upload(ball);
    Scene scene = golden.scene();
    const glm::mat4 turned(glm::vec4(0.8F, 0, -0.6F, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0.6F, 0, 0.8F, 0),
                           glm::vec4(0, 0, 0, 1));
    add_model(scene, block, a, at({-3.2F, 1.2F, 0}) * turned);
    add_model(scene, block, a, at({0, 1.2F, 0}, {-1, 1, 1}) * turned);
    add_model(scene, block, a, at({3.2F, 1.2F, 0}, {1.2F, 0.5F, 1.0F}) * turned);
    add_model(scene, ball, b, at({-3.2F, -1.5F, 0}));
    add_model(scene, ball, b, at({0, -1.5F, 0}, {-1, 1, 1}));
    add_model(scene, ball, b, at({3.2F, -1.5F, 0}, {1.4F, 0.5F, 1.0F}) * turned);
    scene.lights.push_back(lamp({-1.0F, -0.4F, -0.6F}, 1.5F));
    scene.lights.back().casts_shadow = false;
    golden.shoot("mirrored", scene, eye_at({0, 0.6F, 14.5F}, {0, -0.1F, 0}, 0.56F));
}

TEST_CASE("Golden: ghosts, tints and unlit marks") {
    GoldenStudio golden;
    const assets::Model ball = globe(metal({0.9F, 0.72F, 0.45F}, 0.3F)),
                        block = cube(paint({0.2F, 0.3F, 0.35F}));
    const GpuModel gpu_ball = golden.studio.upload(ball), gpu_block = golden.studio.upload(block);
    Scene scene = golden.scene();
    for (int i = 0; i < 3; ++i)
        add_model(scene, block, gpu_block,
                  at({2.4F * static_cast<float>(i - 1), 0, -1.6F}, {0.5F, 1.3F, 0.5F}));
    for (int i = 0; i < 6; ++i)
        add_model(scene, ball, gpu_ball, at({2.4F * static_cast<float>(i % 3 - 1), i < 3 ? 1.1F : -1.1F, 0}));
    Object* balls = &scene.objects[3];
    balls[0].opacity = 0.3F;
    balls[1].tint = {0.1F, 0.6F, 0.2F, 1.0F};
    balls[2].flat = true;
    balls[3].tint = {0.9F, 0.1F, 0.1F, 0.5F};
    balls[3].opacity = 0.7F;
    balls[4].tint = {0.1F, 0.4F, 0.9F, 1.0F};
    balls[4].flat = true;
    scene.lights.push_back(lamp({-0.4F, -0.8F, -0.6F}, 1.5F));
    golden.shoot("ghosts", scene, eye_at({0, 0.8F, 12}, {0, 0, 0}, 0.5F));
}

TEST_CASE("Golden: outlines visible through occluders, and a cut-away cone") {
    GoldenStudio golden;
    const assets::Model ball = globe(metal({0.56F, 0.57F, 0.58F}, 0.3F)),
                        block = cube(paint({0.15F, 0.35F, 0.4F}));
    const GpuModel gpu_ball = golden.studio.upload(ball), gpu_block = golden.studio.upload(block);
    Scene scene = golden.scene();
    for (const float x : {-2.0F, 2.0F}) {
        add_model(scene, ball, gpu_ball, at({x, 0, -1.5F}));
        add_model(scene, block, gpu_block, at({x, -0.6F, 1.0F}, {1.2F, 0.9F, 0.4F}));
    }
    scene.objects[0].outline = {1.0F, 0.6F, 0.0F, 1.0F};
    scene.objects[2].outline = {0.1F, 0.8F, 0.3F, 0.6F};
    scene.objects[3].cut = true;
    scene.cut_away = {{2.0F, -0.2F, -0.5F}, 0.45F, 1.0F};
    scene.lights.push_back(lamp({-0.4F, -0.8F, -0.6F}, 1.5F));
    golden.shoot("marks", scene, eye_at({0, 1.2F, 11}, {0, -0.2F, 0}, 0.5F));
}
