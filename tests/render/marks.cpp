// Outlines, ghosts and cut-aways.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/render/support.hpp"

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr VkExtent2D size{128, 128};

// A ball behind a wall (the plate, upright), with the eye in front of both.
struct Hidden {
    test::Studio studio;
    assets::Model ball = test::sphere({}, 32), wall;
    GpuModel gpu_ball, gpu_wall;
    EnvironmentLight light = studio.light(shading::constant_environment(glm::vec3(0.5F)));
    Scene scene;
    Eye eye;

    Hidden() {
        assets::Material red, green;
        red.base_color = {0.8F, 0.05F, 0.05F, 1.0F};
        red.metallic = 0.0F;
        green = red;
        green.base_color = {0.05F, 0.6F, 0.05F, 1.0F};
        ball = test::sphere(red, 32);
        wall = test::plate(green);
        gpu_ball = studio.upload(ball);
        gpu_wall = studio.upload(wall);
        add_model(scene, ball, gpu_ball);
        glm::mat4 upright(0.0F);  // faces +Z, four times as large
        upright[0] = {4, 0, 0, 0};
        upright[1] = {0, 0, 4, 0};
        upright[2] = {0, -4, 0, 0};
        upright[3] = {0, 0, 2.5F, 1};
        add_model(scene, wall, gpu_wall, upright);
        scene.environment = &light;
        scene.background = {0, 0, 0, 1};
        Perspective p;
        p.fov = 0.6F;
        eye = make_eye({0, 0, 10}, {0, 0, 0}, p);
    }
    Picture shoot() { return studio.shoot(scene, eye, size); }
};

bool greenish(const glm::ivec4& p) { return p.g > p.r + 60; }
bool reddish(const glm::ivec4& p) { return p.r > p.g + 60; }

}  // namespace

TEST_CASE(
    "Outline: the line has the given width, is visible through occluders, and leaves the inside unchanged") {
    Hidden h;
    h.scene.objects[0].outline = {1, 1, 0, 1};
    h.scene.outline_px = 4.0F;
    const Picture with = h.shoot();
    h.scene.objects[0].outline.w = 0.0F;
    const Picture without = h.shoot();
    // The ball's radius in the picture, from the cone of its tangent rays.
    const double radius = std::tan(std::asin(1.0 / 10.0)) / std::tan(0.3) * 64.0;
    int wrong = 0, lines = 0;
    for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x) {
            const double r = std::hypot(x + 0.5 - 64.0, y + 0.5 - 64.0);
            const bool changed = test::pixel(with, x, y) != test::pixel(without, x, y);
            if (r > radius + 1.0 && r < radius + 3.0) {
                ++lines;
                wrong += test::pixel(with, x, y) == glm::ivec4(255, 255, 0, 255) ? 0 : 1;
            }
            if (r < radius - 1.5 || r > radius + 5.5) wrong += changed ? 1 : 0;
        }
    CHECK(lines > 200);
    CHECK(wrong == 0);
}

TEST_CASE("Ghost: objects behind it are visible, and only its own nearest layer is drawn") {
    Hidden h;
    const Picture solid = h.shoot();
    CHECK(greenish(test::pixel(solid, 64, 64)));
    h.scene.objects[1].opacity = 0.3F;
    const Picture ghost = h.shoot();
    const glm::ivec4 middle = test::pixel(ghost, 64, 64), beside = test::pixel(ghost, 20, 64);
    CHECK(middle.r > 60);
    CHECK(beside.g > 20);
    CHECK(beside.g < test::pixel(solid, 20, 64).g - 40);  // the black background darkens it
    // Two walls of one ghost look like one wall: the second copy changes nothing.
    Object second = h.scene.objects[1];
    second.world[3].z -= 0.2F;
    h.scene.objects.push_back(second);
    const Picture both = h.shoot();
    CHECK(test::largest_difference(ghost, both) <= 1);
}

TEST_CASE("Cut-away: shows hidden parts, leaves the rest unchanged, and fades in between") {
    Hidden h;
    const Picture whole = h.shoot();
    h.scene.cut_away = {{0, 0, 0}, 1.2F, 1.0F};
    CHECK(test::largest_difference(h.shoot(), whole) == 0);  // no object has `cut` set
    h.scene.objects[1].cut = true;
    const Picture cut = h.shoot();
    CHECK(reddish(test::pixel(cut, 64, 64)));
    // The picture is unchanged outside the end of the cone; inside it, the wall fades in without a step.
    const double end = 1.2 / 10.0 / std::tan(0.3) * 64.0;
    int changed = 0;
    for (std::uint32_t y = 0; y < size.height; ++y)
        for (std::uint32_t x = 0; x < size.width; ++x)
            if (std::hypot(x + 0.5 - 64.0, y + 0.5 - 64.0) > end + 1.5)
                changed += test::pixel(cut, x, y) != test::pixel(whole, x, y) ? 1 : 0;
    CHECK(changed == 0);
    int before = test::pixel(cut, 64, 64).g;
    for (std::uint32_t x = 64; x < 64 + static_cast<std::uint32_t>(end) + 3; ++x) {
        const int here = test::pixel(cut, x, 64).g;
        CHECK(here >= before - 12);
        CHECK(here - before < 60);
        before = here;
    }
    CHECK(greenish(test::pixel(cut, 64 + static_cast<std::uint32_t>(end) + 3, 64)));
    // Objects behind the focus do not fade.
    h.scene.cut_away.focus = {0, 0, 6};
    CHECK(test::largest_difference(h.shoot(), whole) == 0);
    h.scene.cut_away = {{0, 0, 0}, 1.2F, 0.5F};
    const glm::ivec4 half = test::pixel(h.shoot(), 64, 64);
    CHECK(half.r > 60);
    CHECK(half.g > 60);
}
