// Golden pictures of lights and shadows.
#include <doctest/doctest.h>

#include "tests/golden/golden_studio.hpp"

using namespace bolt;
using namespace bolt::render;
using namespace bolt::test;

namespace {

// A floor with a block and a ball.
struct Table {
    assets::Model floor = plate(paint({0.55F, 0.54F, 0.5F}, 0.8F)), block = cube(paint({0.15F, 0.35F, 0.4F})),
                  ball = globe(metal({0.56F, 0.57F, 0.58F}, 0.3F));
    GpuModel gpu_floor, gpu_block, gpu_ball;

    explicit Table(GoldenStudio& golden)
        : gpu_floor(golden.studio.upload(floor)),
          gpu_block(golden.studio.upload(block)),
          gpu_ball(golden.studio.upload(ball)) {}

    void set(Scene& scene) const {
        add_model(scene, floor, gpu_floor, at({0, 0, 0}, glm::vec3(3.2F)));
        add_model(scene, block, gpu_block, at({-1.0F, 0.6F, -0.4F}, {0.8F, 0.6F, 0.5F}));
        add_model(scene, ball, gpu_ball, at({1.1F, 0.7F, 0.3F}, glm::vec3(0.7F)));
    }
};

Eye above() { return eye_at({1.5F, 4.2F, 7.5F}, {0, 0.3F, 0}); }

}  // namespace

TEST_CASE("Golden: a lamp casts shadows of objects, but not of ghosts and marks") {
    GoldenStudio golden;
    const Table table(golden);
    Scene scene = golden.scene();
    table.set(scene);
    add_model(scene, table.ball, table.gpu_ball, at({-1.9F, 0.4F, 1.4F}, glm::vec3(0.4F)));
    scene.objects.back().opacity = 0.5F;
    add_model(scene, table.block, table.gpu_block, at({0.1F, 0.25F, 1.9F}, glm::vec3(0.25F)));
    scene.objects.back().flat = true;
    scene.lights.push_back(lamp({0.7F, -1.0F, 0.25F}, 2.0F));
    scene.environment_intensity = 0.35F;
    golden.shoot("shadow", scene, above());
}

TEST_CASE("Golden: ambient occlusion darkens the floor under and between objects") {
    GoldenStudio golden;
    const Table table(golden);
    Scene scene = golden.scene();
    table.set(scene);
    add_model(scene, table.block, table.gpu_block, at({-0.1F, 0.4F, -0.9F}, {0.15F, 0.4F, 1.0F}));
    scene.occlusion_radius = 0.6F;
    golden.shoot("occlusion", scene, above());
}

TEST_CASE("Golden: a point light with a range and a spot light illuminate objects") {
    GoldenStudio golden;
    const Table table(golden);
    Scene scene = golden.scene();
    table.set(scene);
    assets::Model lights;
    for (int i = 0; i < 2; ++i) {
        assets::Light light;
        light.type = i == 0 ? assets::LightType::point : assets::LightType::spot;
        light.color = i == 0 ? glm::vec3(1.0F, 0.6F, 0.3F) : glm::vec3(0.5F, 0.7F, 1.0F);
        light.intensity = i == 0 ? 3.0F : 14.0F;
        light.range = i == 0 ? 2.5F : 0.0F;
        light.inner_cone = 0.25F;
        light.outer_cone = 0.4F;
        lights.lights.push_back(light);
        assets::Node node;
        node.light = i;
        node.translation = i == 0 ? glm::vec3(0.1F, 0.9F, 0.8F) : glm::vec3(1.2F, 3.0F, 0.2F);
        node.rotation = glm::angleAxis(-1.5707963F, glm::vec3(1, 0, 0));  // downwards
        lights.nodes.push_back(node);
        lights.roots.push_back(i);
    }
    add_lights(scene, lights);
    scene.environment_intensity = 0.15F;
    golden.shoot("lamps", scene, above());
}

TEST_CASE("Golden: the sky and its reflection follow rotation, intensity and exposure") {
    GoldenStudio golden;
    assets::Model ball = globe(metal(glm::vec3(0.95F), 0.0F));
    const GpuModel gpu_ball = golden.studio.upload(ball);
    std::vector<Picture> pictures;
    for (const float turn : {0.0F, 1.2F}) {
        Scene scene = golden.scene();
        scene.background.w = 0.0F;
        scene.environment_turn = turn;
        scene.environment_intensity = turn > 0.0F ? 1.6F : 1.0F;
        scene.exposure = turn > 0.0F ? 0.5F : 1.0F;
        add_model(scene, ball, gpu_ball, at({0, 0, 0}));
        pictures.push_back(
            golden.studio.shoot(scene, eye_at({0, 0.8F, 4}, {0, 0, 0}, 1.0F, 1.0F), {112, 112}));
    }
    golden.check("sky", joined(pictures));
}
