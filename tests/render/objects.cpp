// Transformed objects.
#include <doctest/doctest.h>

#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

TEST_CASE("Objects: a mirrored ball looks like the ball, from outside and through a cut from inside") {
    test::Studio studio;
    assets::Material metal;
    metal.base_color = {0.9F, 0.6F, 0.3F, 1.0F};
    metal.roughness = 0.35F;
    assets::Model ball = test::sphere(metal, 48);
    assets::Model bowl = ball;
    bowl.materials[0].double_sided = true;
    auto& indices = bowl.meshes[0].primitives[0].indices;
    indices.erase(indices.begin(), indices.begin() + static_cast<std::ptrdiff_t>(indices.size() / 2));
    const GpuModel gpu_ball = studio.upload(ball), gpu_bowl = studio.upload(bowl);
    const EnvironmentLight light = studio.light(shading::studio_environment(64));
    Perspective p;
    p.fov = 0.6F;
    const Eye eye = make_eye({0, 3, 6}, {0, 0, 0}, p);
    for (const bool open : {false, true}) {
        CAPTURE(open);
        Scene scene;
        scene.environment = &light;
        scene.background = {0.3F, 0.3F, 0.3F, 1.0F};
        SceneLight lamp;
        lamp.light.direction = {-0.5F, -0.6F, -0.6F, 0.0F};
        lamp.light.color = {2, 2, 2, 0};
        scene.lights.push_back(lamp);
        add_model(scene, open ? bowl : ball, open ? gpu_bowl : gpu_ball);
        const Picture straight = studio.shoot(scene, eye, {96, 96});
        scene.objects[0].world[0][0] = -1.0F;
        // The mirrored quads are divided along the other diagonal, and at triangle edges a pixel takes its
        // normal from another point.
        CHECK(test::largest_difference(straight, studio.shoot(scene, eye, {96, 96})) <= 24);
        // Negative control: a rotated ball has its highlight elsewhere.
        scene.objects[0].world[0][0] = 1.0F;
        scene.lights[0].light.direction = {0.5F, -0.6F, -0.6F, 0.0F};
        CHECK(test::largest_difference(straight, studio.shoot(scene, eye, {96, 96})) > 60);
    }
}

TEST_CASE("Objects: more materials than the geometry buffer can index are an error") {
    test::Studio studio;
    const assets::Model model = test::plate({});
    GpuModel gpu_model = studio.upload(model);
    Scene scene;
    add_model(scene, model, gpu_model);
    gpu_model.materials.resize(max_materials + 1);
    const Eye eye = make_eye({0, 3, 6}, {0, 0, 0}, {});
    const auto refused =
        take_pictures(studio.device(), studio.frames(), studio.renderer(), scene, {&eye, 1}, {8, 8});
    REQUIRE_FALSE(refused);
    CHECK(refused.error().message() == "the scene's models have 32769 materials; expected at most 32768");
}
