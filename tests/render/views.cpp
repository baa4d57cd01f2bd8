#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"
#include "engine/render/draw_list.hpp"
#include "tests/render/support.hpp"

namespace render_views_test {

using namespace bolt;
using namespace bolt::render;

namespace {

// Three balls of different materials in studio light.
struct Still {
    test::Studio studio;
    assets::Model model;
    GpuModel gpu_model;
    EnvironmentLight light = studio.light(shading::studio_environment(128));
    Scene scene;

    Still() {
        assets::Material metal;
        metal.base_color = {0.9F, 0.6F, 0.3F, 1.0F};
        metal.roughness = 0.3F;
        model = test::sphere(metal, 32);
        gpu_model = studio.upload(model);
        for (const float x : {-2.2F, 0.0F, 2.2F}) {
            glm::mat4 world(1.0F);
            world[3] = {x, 0.2F * x, -0.3F * x, 1.0F};
            add_model(scene, model, gpu_model, world);
        }
        scene.objects[1].tint = {0.2F, 0.5F, 0.9F, 1.0F};
        scene.environment = &light;
    }
};

}  // namespace

TEST_CASE("Views: several views at once equal single pictures") {
    Still still;
    Perspective p;
    p.fov = 0.7F;
    const Eye eyes[] = {make_eye({-0.032F, 0.5F, 8}, {-0.032F, 0, 0}, p),
                        make_eye({0.032F, 0.5F, 8}, {0.032F, 0, 0}, p)};
    const std::vector<Picture> both = still.studio.shoot(still.scene, eyes, {96, 96});
    REQUIRE(both.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
        const Picture one = still.studio.shoot(still.scene, eyes[i], {96, 96});
        CHECK(test::largest_difference(both[i], one) <= 1);
    }
    CHECK(test::largest_difference(both[0], both[1]) > 20);  // the two pictures differ
}

TEST_CASE("Views: two walls with a common edge show the picture of one wall without a seam") {
    Still still;
    const glm::vec3 eye(0.4F, 0.3F, 8.0F);
    const auto wall = [&](float from, float to) {
        return make_wall_eye(eye, {from, -2, 4}, {to, -2, 4}, {from, 2, 4}, 0.1F, 50.0F);
    };
    const Picture whole = still.studio.shoot(still.scene, wall(-4, 4), {128, 64});
    const Picture left = still.studio.shoot(still.scene, wall(-4, 0), {64, 64});
    const Picture right = still.studio.shoot(still.scene, wall(0, 4), {64, 64});
    int largest = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 128; ++x) {
            const glm::ivec4 d =
                test::pixel(whole, x, y) - (x < 64 ? test::pixel(left, x, y) : test::pixel(right, x - 64, y));
            largest = std::max({largest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        }
    // Rounding decides which samples an edge covers, and the covered samples determine where the pixel's
    // colour is evaluated.
    CHECK(largest <= 10);
    // Walls at a right angle: a point on their common edge is projected to the edge of both pictures.
    const Eye side = make_wall_eye(eye, {4, -2, 4}, {4, -2, 12}, {4, 2, 4}, 0.1F, 50.0F);
    const Eye ahead = wall(-4, 4);
    for (const float y : {-2.0F, 0.0F, 1.5F}) {
        const glm::vec4 a = ahead.clip_from_world * glm::vec4(4, y, 4, 1),
                        b = side.clip_from_world * glm::vec4(4, y, 4, 1);
        CHECK(a.x / a.w == doctest::Approx(1.0).epsilon(1e-4));
        CHECK(b.x / b.w == doctest::Approx(-1.0).epsilon(1e-4));
        CHECK(a.y / a.w == doctest::Approx(static_cast<double>(b.y / b.w)).epsilon(1e-4));
    }
}

TEST_CASE("Views: the same scene gives the same bits, also after changes of size") {
    Still still;
    Perspective p;
    const Eye eye = make_eye({1, 1, 8}, {0, 0, 0}, p);
    const Picture first = still.studio.shoot(still.scene, eye, {80, 60});
    (void)still.studio.shoot(still.scene, eye, {33, 17});
    CHECK(still.studio.shoot(still.scene, eye, {80, 60}).rgba == first.rgba);
}

TEST_CASE("Culling: visible objects are never culled, and instances are merged") {
    Still still;
    Random random(5);
    Perspective p;
    for (int round = 0; round < 2000; ++round) {
        const auto coordinate = [&] { return static_cast<float>(random.uniform(-5.0, 5.0)); };
        const Eye eye = make_eye({coordinate(), coordinate(), coordinate()},
                                 {coordinate(), coordinate(), coordinate()}, p);
        BoundingBox box;
        for (int i = 0; i < 2; ++i) box.add({coordinate(), coordinate(), coordinate()});
        bool visible = false;
        for (int i = 0; i < 50; ++i) {
            const auto between = [&](int axis) {
                return static_cast<float>(
                    random.uniform(static_cast<double>(box.low[axis]), static_cast<double>(box.high[axis])));
            };
            const glm::vec4 c = eye.clip_from_world * glm::vec4(between(0), between(1), between(2), 1.0F);
            visible |=
                c.w > 0.0F && std::abs(c.x) <= c.w && std::abs(c.y) <= c.w && c.z >= 0.0F && c.z <= c.w;
        }
        if (visible) REQUIRE(may_be_visible(box, eye.clip_from_world));
    }
    const Eye away = make_eye({0, 0, 8}, {0, 0, 20}, p);
    CHECK(make_draw_list(still.scene, {&away, 1}, {}).draws.empty());
    const Eye eye = make_eye({0, 0, 12}, {0, 0, 0}, p);
    const DrawList list = make_draw_list(still.scene, {&eye, 1}, {});
    REQUIRE(list.draws.size() == 2);  // the tinted one needs another pipeline
    CHECK(list.draws[0].instances + list.draws[1].instances == 3);
    CHECK(list.forward.empty());
    still.scene.objects[0].opacity = 0.5F;
    const DrawList ghost = make_draw_list(still.scene, {&eye, 1}, {});
    REQUIRE(ghost.draws.size() == 3);
    CHECK(!ghost.forward.empty());
    CHECK_FALSE(ghost.draws[1].kind.blends);
    CHECK(ghost.draws[2].kind.blends);
}

TEST_CASE("Levels of detail: the error stays below the limit, and distant parts are coarser") {
    test::Studio studio;
    const assets::Model model = test::sphere({}, 96);
    const GpuModel gpu_model = studio.upload(model, {true});
    Scene scene;
    add_model(scene, model, gpu_model);
    const MeshPart& part = gpu_model.parts.front();
    REQUIRE(part.levels.size() > 2);
    for (std::size_t i = 1; i < part.levels.size(); ++i) {
        CHECK(part.levels[i].index_count < part.levels[i - 1].index_count);
        CHECK(part.levels[i].error > part.levels[i - 1].error);
    }
    Perspective p;
    std::uint64_t before = ~std::uint64_t{0};
    for (const float distance : {1.5F, 6.0F, 40.0F, 400.0F}) {
        p.zfar = 2.0F * distance;
        const Eye eye = make_eye({0, 0, distance}, {0, 0, 0}, p);
        CHECK(make_draw_list(scene, {&eye, 1}, {}).draws.front().level == 0);
        const DrawList list = make_draw_list(scene, {&eye, 1}, {720.0F, 0.5F, 0.0F});
        const float metre_px = 0.5F * 720.0F / std::tan(0.5F * p.fov) / (distance - 1.0F);
        CHECK(part.levels[list.draws.front().level].error * metre_px <= 0.5F);
        CHECK(list.triangles <= before);
        before = list.triangles;
    }
    CHECK(before < part.levels[0].index_count / 30);
    // If the part reaches behind the eye, all triangles are drawn.
    const Eye inside = make_eye({0, 0, 0.5F}, {0, 0, -1}, p);
    CHECK(make_draw_list(scene, {&inside, 1}, {720.0F, 0.5F, 0.0F}).draws.front().level == 0);
}

TEST_CASE("Shadow: the map of static objects is kept while another object moves") {
    Still still;
    const assets::Model plate = test::plate({});
    const GpuModel ground = still.studio.upload(plate);
    glm::mat4 world(4.0F);  // wide enough that the balls do not change the extent of the map
    world[3] = {0, -1.6F, 0, 1};
    add_model(still.scene, plate, ground, world);
    SceneLight sun;
    sun.light.direction = {0, -1, 0, 0};
    sun.light.color = glm::vec4(2.0F);
    sun.casts_shadow = true;
    still.scene.lights = {sun};
    Perspective p;
    const Eye eye = make_eye({0, 6, 9}, {0, -1, 0}, p);
    const Picture before = still.studio.shoot(still.scene, eye, {128, 96});
    CHECK(still.studio.renderer().statistics().static_shadow_redrawn);
    still.scene.objects[0].moves = true;
    const Picture apart = still.studio.shoot(still.scene, eye, {128, 96});
    CHECK(
        still.studio.renderer().statistics().static_shadow_redrawn);  // the set of static objects has changed
    CHECK(test::largest_difference(before, apart) == 0);
    still.scene.objects[0].world[3].z += 0.8F;
    const Picture moved = still.studio.shoot(still.scene, eye, {128, 96});
    CHECK_FALSE(still.studio.renderer().statistics().static_shadow_redrawn);
    still.scene.objects[0].moves = false;
    const Picture anew = still.studio.shoot(still.scene, eye, {128, 96});
    CHECK(still.studio.renderer().statistics().static_shadow_redrawn);
    CHECK(test::largest_difference(moved, anew) == 0);
    CHECK(test::largest_difference(before, moved) > 50);
}

}  // namespace render_views_test
