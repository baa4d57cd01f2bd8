// Surfaces under light whose radiance has a closed form.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/render/support.hpp"

namespace render_light_test {

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr VkExtent2D extent{96, 96};

Eye front() {
    Perspective p;
    p.fov = 0.5F;
    p.znear = 1.0F;
    return make_eye({0, 0, 6}, {0, 0, 0}, p);
}

assets::Material white(float metallic, float roughness, float coat = 0.0F) {
    assets::Material m;
    m.metallic = metallic;
    m.roughness = roughness;
    m.clearcoat = coat;
    m.clearcoat_roughness = 0.2F;
    return m;
}

}  // namespace

TEST_CASE("White furnace: a white sphere in white surroundings is invisible within 1 %") {
    test::Studio studio;
    const EnvironmentLight light = studio.light(shading::constant_environment(glm::vec3(0.5F)));
    for (const float coat : {0.0F, 1.0F}) {
        for (const float metallic : {0.0F, 0.5F, 1.0F}) {
            for (const float roughness : {0.0F, 0.25F, 0.5F, 0.75F, 1.0F}) {
                CAPTURE(coat);
                CAPTURE(metallic);
                CAPTURE(roughness);
                const assets::Model model = test::sphere(white(metallic, roughness, coat));
                const GpuModel gpu_model = studio.upload(model);
                Scene scene;
                add_model(scene, model, gpu_model);
                scene.environment = &light;
                const Picture picture = studio.shoot(scene, front(), extent);
                double worst = 0.0;
                for (std::uint32_t y = 0; y < extent.height; ++y)
                    for (std::uint32_t x = 0; x < extent.width; ++x)
                        worst = std::max(worst, std::abs(test::grey_radiance(static_cast<std::uint8_t>(
                                                             test::pixel(picture, x, y).g)) /
                                                             0.5 -
                                                         1.0));
                CHECK(worst < 0.01);
            }
        }
    }
}

TEST_CASE("White furnace: a grey sphere is visible (negative control)") {
    test::Studio studio;
    const EnvironmentLight light = studio.light(shading::constant_environment(glm::vec3(0.5F)));
    assets::Material grey = white(0.0F, 0.5F);
    grey.base_color = {0.8F, 0.8F, 0.8F, 1.0F};
    const assets::Model model = test::sphere(grey);
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    add_model(scene, model, gpu_model);
    scene.environment = &light;
    const Picture picture = studio.shoot(scene, front(), extent);
    CHECK(test::grey_radiance(static_cast<std::uint8_t>(test::pixel(picture, 48, 48).g)) < 0.45);
}

TEST_CASE("Light: a matte sphere under a directional light is Lambertian: albedo / π · irradiance · cosine") {
    test::Studio studio;
    assets::Material dull = white(0.0F, 1.0F);
    dull.specular = 0.0F;
    const assets::Model model = test::sphere(dull, 128);
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    add_model(scene, model, gpu_model);
    SceneLight light;
    const glm::vec3 towards = glm::normalize(glm::vec3(0.4F, 0.5F, 0.8F));
    light.light.direction = glm::vec4(-towards, 0.0F);
    constexpr double irradiance = 0.7 * std::numbers::pi;
    light.light.color = glm::vec4(glm::vec3(static_cast<float>(irradiance)), 0.0F);
    scene.lights.push_back(light);
    const Picture picture = studio.shoot(scene, front(), extent);
    int compared = 0;
    for (std::uint32_t y = 0; y < extent.height; y += 3) {
        for (std::uint32_t x = 0; x < extent.width; x += 3) {
            // Intersect the ray through the pixel with the sphere.
            const double t = std::tan(0.25);
            const glm::dvec3 d =
                glm::normalize(glm::dvec3(((x + 0.5) / 48.0 - 1.0) * t, -((y + 0.5) / 48.0 - 1.0) * t, -1.0));
            const double b = glm::dot(glm::dvec3(0, 0, 6), d), c = 36.0 - 0.97;
            if (b * b < c) continue;  // skip the silhouette
            const double e = glm::dot(glm::dvec3(0, 0, 6), d);
            const glm::dvec3 hit = glm::dvec3(0, 0, 6) + d * (-e - std::sqrt(e * e - 35.0));
            const double expected = 0.7 * glm::dot(hit, glm::dvec3(towards));
            if (expected < 0.1) continue;
            const double seen = test::grey_radiance(static_cast<std::uint8_t>(test::pixel(picture, x, y).g));
            CHECK(seen == doctest::Approx(expected).epsilon(0.012));
            ++compared;
        }
    }
    CHECK(compared > 200);
}

TEST_CASE("Shadow: a plate shades the plate below it and nothing else") {
    test::Studio studio;
    assets::Material dull = white(0.0F, 1.0F);
    dull.specular = 0.0F;
    const assets::Model model = test::plate(dull);
    const GpuModel gpu_model = studio.upload(model);
    Scene scene;
    add_model(scene, model, gpu_model,
              glm::mat4(glm::vec4(4, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 4, 0),
                        glm::vec4(0, 0, 0, 1)));
    add_model(scene, model, gpu_model,
              glm::mat4(glm::vec4(0.5F, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 0.5F, 0),
                        glm::vec4(1, 1, 0, 1)));
    SceneLight light;
    light.light.direction =
        glm::vec4(glm::normalize(glm::vec3(-1, -1, 0)), 0.0F);  // moves the shadow by 1 towards -x
    light.light.color = glm::vec4(2.0F, 2.0F, 2.0F, 0.0F);
    light.casts_shadow = true;
    scene.lights.push_back(light);
    Perspective p;
    p.fov = 0.8F;
    p.znear = 1.0F;
    // The view is from above; the upper plate hides only the area to the right of its shadow.
    const Picture picture = studio.shoot(scene, make_eye({0, 10, 0}, {0, 0, 0}, p), extent);
    const auto at = [&](float x, float z) {  // green level of the lower plate
        const float scale = 48.0F / (10.0F * std::tan(0.4F));
        return test::pixel(picture, static_cast<std::uint32_t>(48.0F + x * scale),
                           static_cast<std::uint32_t>(48.0F + z * scale))
            .g;
    };
    CHECK(at(0.0F, 0.0F) < 8);  // the shadow of the upper plate's centre
    CHECK(at(-0.35F, 0.35F) < 8);
    CHECK(at(-1.0F, 0.0F) > 150);
    CHECK(at(0.0F, 1.0F) > 150);
    CHECK(at(-2.5F, -2.5F) > 150);
    CHECK(at(1.0F, 0.0F) > 150);  // the upper plate has no shadow acne
    // The shadow map is redrawn only when an object has moved.
    CHECK(studio.renderer().statistics().static_shadow_redrawn);
    (void)studio.shoot(scene, make_eye({0, 10, 0}, {0, 0, 0}, p), extent);
    CHECK_FALSE(studio.renderer().statistics().static_shadow_redrawn);
    scene.objects.back().world[3].x += 0.5F;
    (void)studio.shoot(scene, make_eye({0, 10, 0}, {0, 0, 0}, p), extent);
    CHECK(studio.renderer().statistics().static_shadow_redrawn);
}

TEST_CASE("Ambient occlusion: an open floor is not occluded, and a wall occludes half of the floor's sky") {
    test::Studio studio;
    assets::Material dark = white(0.0F, 1.0F);
    dark.specular = 0.0F;
    dark.base_color = {0.1F, 0.1F, 0.1F, 1.0F};
    dark.double_sided = true;
    const assets::Model model = test::plate(dark);
    const GpuModel gpu_model = studio.upload(model);
    const EnvironmentLight light = studio.light(shading::constant_environment(glm::vec3(5.0F)));
    Scene scene;
    scene.environment = &light;
    const glm::mat4 floor(glm::vec4(4, 0, 0, 0), glm::vec4(0, 1, 0, 0), glm::vec4(0, 0, 4, 0),
                          glm::vec4(0, 0, 0, 1));
    const glm::mat4 wall(glm::vec4(0, 4, 0, 0), glm::vec4(-1, 0, 0, 0), glm::vec4(0, 0, 4, 0),
                         glm::vec4(0, 4, 0, 1));
    add_model(scene, model, gpu_model, floor);
    add_model(scene, model, gpu_model, wall);
    scene.occlusion_radius = 1.0F;
    Perspective p;
    p.fov = 0.7F;
    p.znear = 1.0F;
    // The eye is to the right of the wall at x = 0 and above the floor.
    const Eye eye = make_eye({4, 7, 0}, {1.6F, 0, 0}, p);
    const Picture picture = studio.shoot(scene, eye, {160, 120});
    const auto free_share = [&](float x) {
        const glm::vec4 clip = eye.clip_from_world * glm::vec4(x, 0, 0.1F, 1);
        const auto column = static_cast<std::uint32_t>((clip.x / clip.w + 1.0F) * 80.0F);
        const auto row = static_cast<std::uint32_t>((clip.y / clip.w + 1.0F) * 60.0F);
        return test::grey_radiance(static_cast<std::uint8_t>(test::pixel(picture, column, row).g)) / 0.5;
    };
    CHECK(free_share(2.5F) == doctest::Approx(1.0).epsilon(0.04));
    CHECK(free_share(0.06F) < 0.72);  // half, plus a margin for the transition
    CHECK(free_share(0.06F) > 0.40);
    CHECK(free_share(0.5F) > free_share(0.06F) + 0.1);
    CHECK(free_share(0.5F) < 1.0);
    scene.occlusion_radius = 0.0F;
    const Picture without = studio.shoot(scene, eye, {160, 120});
    CHECK(test::largest_difference(picture, without) > 30);
}

}  // namespace render_light_test
