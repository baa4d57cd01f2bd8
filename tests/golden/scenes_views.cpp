// Golden pictures of several views and of the ZQ350 reducer.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>

#include "engine/assets/gltf.hpp"
#include "tests/golden/golden_studio.hpp"

using namespace bolt;
using namespace bolt::render;
using namespace bolt::test;

namespace {

// The ZQ350 with the set-up of `boltwright render`.
struct Reducer {
    GoldenStudio golden;
    assets::Model model;
    GpuModel gpu_model;
    Scene scene = golden.scene();

    Reducer() {
        const char* folder = std::getenv("BOLTWRIGHT_CONTENT");
        REQUIRE(folder != nullptr);
        auto read = assets::read_gltf(std::filesystem::path(folder) / "assemblies/zq350/zq350.glb");
        REQUIRE(read.has_value());
        model = std::move(*read);
        gpu_model = golden.studio.upload(model);
        add_model(scene, model, gpu_model);
        SceneLight key = lamp({0.45F, -1.0F, -0.55F}, 1.0F);
        key.light.color = {1.6F, 1.55F, 1.5F, 0.0F};
        scene.lights.push_back(key);
        const BoundingBox box = bounds(scene);
        scene.occlusion_radius = 0.04F * glm::distance(box.low, box.high);
    }
    void shoot(const char* name, const glm::vec3& eye, const glm::vec3& target, float fov) {
        golden.shoot(name, scene, eye_at(eye, target, fov), {256, 192});
    }
};

}  // namespace

TEST_CASE("Golden: the ZQ350, whole, from above and near a joint") {
    Reducer reducer;
    reducer.shoot("zq350-overview", {0.2F, 0.62F, 0.9F}, {0.2F, 0.04F, 0.0F}, 0.64F);
    reducer.shoot("zq350-top", {0.175F, 1.15F, 0.001F}, {0.175F, 0.0F, 0.0F}, 0.7F);
    // The nuts B7 and B8 with their threads, and a bolt of the end flange.
    reducer.shoot("zq350-nut", {0.14F, 0.22F, 0.34F}, {0.05F, 0.075F, 0.12F}, 0.5F);
    reducer.shoot("zq350-flange", {-0.3F, 0.12F, 0.2F}, {-0.14F, 0.02F, 0.06F}, 0.5F);
}

TEST_CASE("Golden: the ZQ350 in stereo") {
    Reducer reducer;
    std::vector<Eye> eyes;
    for (const float x : {-0.0315F, 0.0315F})
        eyes.push_back(eye_at({0.3F + x, 0.35F, 0.55F}, {0.175F + x, 0.03F, 0.05F}, 0.7F, 1.0F));
    reducer.golden.check("stereo", joined(reducer.golden.studio.shoot(reducer.scene, eyes, {128, 128})));
}

TEST_CASE("Golden: three walls at right angles, off-axis from one eye") {
    GoldenStudio golden;
    assets::Model floor = plate(paint({0.55F, 0.54F, 0.5F}, 0.8F));
    floor.meshes[0].primitives[0].texcoords[0] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    floor.materials[0].base_color_texture.texture = add_texture(floor, 64, [](int x, int y) {
        return (x / 4 + y / 4) % 2 == 0 ? glm::vec4(1.0F) : glm::vec4(0.5F, 0.5F, 0.5F, 1.0F);
    });
    const assets::Model ball = globe(metal({0.9F, 0.72F, 0.45F}, 0.25F));
    const GpuModel gpu_floor = golden.studio.upload(floor), gpu_ball = golden.studio.upload(ball);
    Scene scene = golden.scene();
    add_model(scene, floor, gpu_floor, at({0, -1, 0}, glm::vec3(6.0F)));
    // Two of the balls are on the edges between the walls.
    for (const float x : {-4.0F, -2.4F, 0.0F, 2.4F, 4.0F})
        add_model(scene, ball, gpu_ball, at({x, -0.3F, x * x < 9.0F ? -3.0F : 0.5F}, glm::vec3(0.7F)));
    const glm::vec3 eye(0.4F, 0.2F, 0.3F);
    const float side = 1.5F, back = -1.5F, front = 1.5F, low = -1.0F, high = 1.5F;
    const Eye walls[] = {
        make_wall_eye(eye, {-side, low, front}, {-side, low, back}, {-side, high, front}, 0.1F, 20.0F),
        make_wall_eye(eye, {-side, low, back}, {side, low, back}, {-side, high, back}, 0.1F, 20.0F),
        make_wall_eye(eye, {side, low, back}, {side, low, front}, {side, high, back}, 0.1F, 20.0F)};
    golden.check("walls", joined(golden.studio.shoot(scene, walls, {84, 70})));
}
