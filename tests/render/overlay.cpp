#include "engine/render/renderer.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/render/support.hpp"

namespace render_overlay_test {

using namespace bolt;
using namespace bolt::render;

namespace {

constexpr VkExtent2D extent{64, 48};

// A scene of one plain colour: linear 0.05, below the shoulder of the tone mapping.
Scene plain(float level = 0.05F) {
    Scene scene;
    scene.background = glm::vec4(glm::vec3(level), 1.0F);
    return scene;
}

// Draws the scene with an overlay in one frame.
Picture with_overlay(test::Studio& studio, const Scene& scene, const Overlay& overlay) {
    gpu::FrameContext* frame = studio.gpu().need(studio.frames().begin());
    const Eye eye = make_eye({0, 0, 5}, {0, 0, 0}, {});
    studio.gpu().need(studio.renderer().render(*frame, scene, {&eye, 1}, extent));
    studio.gpu().need(studio.renderer().draw_over(*frame, overlay, studio.renderer().picture(0)));
    studio.gpu().need(studio.frames().submit(*frame));
    return studio.download(studio.renderer().picture(0));
}

int encoded(double linear_value) {
    const double x =
        linear_value <= 0.0031308 ? 12.92 * linear_value : 1.055 * std::pow(linear_value, 1.0 / 2.4) - 0.055;
    return static_cast<int>(std::lround(255.0 * x));
}

// Returns the number of pixels with a channel that differs from `wanted` by more than the tolerance.
template <class Wanted>
int wrong(const Picture& picture, const Wanted& wanted, int tolerance) {
    int count = 0;
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const glm::ivec4 d = glm::abs(test::pixel(picture, x, y) - wanted(x, y));
            count += d.x > tolerance || d.y > tolerance || d.z > tolerance ? 1 : 0;
        }
    return count;
}

}  // namespace

TEST_CASE("Overlay: a rectangle covers exactly its pixels in its exact colour") {
    test::Studio studio;
    const Picture bare = studio.shoot(plain(), make_eye({0, 0, 5}, {0, 0, 0}, {}), extent);
    Overlay overlay;
    const glm::ivec4 color(200, 37, 5, 255);
    add_rectangle(overlay, {{7, 5}, {20, 31}}, glm::vec4(color) / 255.0F);
    const Picture made = with_overlay(studio, plain(), overlay);
    const auto wanted = [&](std::uint32_t x, std::uint32_t y) {
        return x >= 7 && x < 20 && y >= 5 && y < 31 ? color : test::pixel(bare, x, y);
    };
    CHECK(wrong(made, wanted, 0) == 0);
    // Negative control: one more row and column is detected.
    overlay = {};
    add_rectangle(overlay, {{7, 5}, {21, 32}}, glm::vec4(color) / 255.0F);
    CHECK(wrong(with_overlay(studio, plain(), overlay), wanted, 0) == 14 + 26);
    // Every screen value is reproduced exactly.
    overlay = {};
    for (int i = 0; i < 64; ++i) {
        const auto x = static_cast<float>(i);
        add_rectangle(overlay, {{x, 0}, {x + 1.0F, 48}},
                      {static_cast<float>(4 * i) / 255.0F, static_cast<float>(4 * i + 1) / 255.0F,
                       static_cast<float>(4 * i + 2) / 255.0F, 1.0F});
    }
    const Picture ramp = with_overlay(studio, plain(), overlay);
    CHECK(wrong(
              ramp,
              [](std::uint32_t x, std::uint32_t) {
                  const int i = static_cast<int>(x);
                  return glm::ivec4(4 * i, 4 * i + 1, 4 * i + 2, 255);
              },
              0) == 0);
}

TEST_CASE("Overlay: translucent colours blend linearly, and later draws cover earlier ones") {
    test::Studio studio;
    const Picture bare = studio.shoot(plain(), make_eye({0, 0, 5}, {0, 0, 0}, {}), extent);
    Overlay overlay;
    add_rectangle(overlay, {{0, 0}, {32, 48}}, {0, 0, 0, 1});
    add_rectangle(overlay, {{0, 0}, {64, 24}}, {1, 1, 1, 0.4F});
    const Picture made = with_overlay(studio, plain(), overlay);
    CHECK(std::abs(test::pixel(made, 10, 10).g - encoded(0.4)) <= 1);
    CHECK(test::pixel(made, 10, 40).g == 0);
    CHECK(test::pixel(made, 50, 40) == test::pixel(bare, 50, 40));
    const auto of_scene = static_cast<double>(test::pixel(bare, 50, 10).g) / 255.0;
    const double linear_scene = std::pow((of_scene + 0.055) / 1.055, 2.4);
    CHECK(std::abs(test::pixel(made, 50, 10).g - encoded(0.6 * linear_scene + 0.4)) <= 1);
    // Blending of encoded values would give another colour.
    CHECK(encoded(0.4) - static_cast<int>(std::lround(0.4 * 255.0)) > 40);
}

TEST_CASE("Overlay: a scissor clips at whole pixels, also where it extends beyond the picture") {
    test::Studio studio;
    const Picture bare = studio.shoot(plain(), make_eye({0, 0, 5}, {0, 0, 0}, {}), extent);
    Overlay overlay;
    add_rectangle(overlay, {{0, 0}, {64, 48}}, glm::vec4(1.0F));
    overlay.draws[0].scissor = {{-5, 40}, {20, 100}};
    add_rectangle(overlay, {{0, 0}, {64, 48}}, glm::vec4(1.0F));
    overlay.draws[1].scissor = {{60, -3}, {2000000000, 6}};
    add_rectangle(overlay, {{0, 0}, {64, 48}}, glm::vec4(1.0F));
    overlay.draws[2].scissor = {{70, 0}, {10, 10}};  // completely outside
    const Picture made = with_overlay(studio, plain(), overlay);
    CHECK(wrong(
              made,
              [&](std::uint32_t x, std::uint32_t y) {
                  const bool inside = (x < 15 && y >= 40) || (x >= 60 && y < 3);
                  return inside ? glm::ivec4(255) : test::pixel(bare, x, y);
              },
              0) == 0);
}

TEST_CASE(
    "Inset: equals the single picture of its view with a frame, and the rest of the picture is unchanged") {
    test::Studio studio;
    assets::Material metal;
    metal.base_color = {0.9F, 0.6F, 0.3F, 1.0F};
    metal.roughness = 0.3F;
    const assets::Model model = test::sphere(metal, 32);
    const GpuModel gpu_model = studio.upload(model);
    const EnvironmentLight light = studio.light(shading::studio_environment(128));
    Scene scene;
    add_model(scene, model, gpu_model);
    scene.environment = &light;
    scene.occlusion_radius = 0.2F;
    constexpr VkExtent2D whole{160, 90}, small{48, 27};
    Perspective lens;
    lens.aspect = 16.0F / 9.0F;
    const Eye eye = make_eye({0, 0, 5}, {0, 0, 0}, lens), other = make_eye({3, 2, 3}, {0, 0, 0}, lens);
    const Picture main = studio.shoot(scene, eye, whole), single = studio.shoot(scene, other, small);

    const auto compose = [&](const Eye& shown) {
        gpu::FrameContext* frame = studio.gpu().need(studio.frames().begin());
        Renderer& renderer = studio.renderer();
        studio.gpu().need(renderer.render(*frame, scene, {&eye, 1}, whole));
        studio.gpu().need(renderer.render(*frame, scene, {&shown, 1}, small, 1));
        Overlay overlay;
        add_inset(overlay, {{104, 55}, {152, 82}}, renderer.picture(0, 1), 2.0F, {1, 1, 0, 1});
        studio.gpu().need(renderer.draw_over(*frame, overlay, renderer.picture(0)));
        studio.gpu().need(studio.frames().submit(*frame));
        return studio.download(renderer.picture(0));
    };
    const auto wanted = [&](std::uint32_t x, std::uint32_t y) {
        if (x >= 104 && x < 152 && y >= 55 && y < 82) return test::pixel(single, x - 104, y - 55);
        if (x >= 102 && x < 154 && y >= 53 && y < 84) return glm::ivec4(255, 255, 0, 255);
        return test::pixel(main, x, y);
    };
    for (int round = 0; round < 3; ++round)  // images are reused from frame to frame
        CHECK(wrong(compose(other), wanted, 1) == 0);
    CHECK(test::largest_difference(studio.download(studio.renderer().picture(0, 1)), single) <= 1);
    CHECK(wrong(compose(make_eye({3, 2.2F, 3}, {0, 0, 0}, lens)), wanted, 1) > 50);  // negative control
    // Drawing a picture onto itself is an error, and the frame continues.
    gpu::FrameContext* frame = studio.gpu().need(studio.frames().begin());
    studio.gpu().need(studio.renderer().render(*frame, scene, {&eye, 1}, whole));
    Overlay overlay;
    add_picture(overlay, {{0, 0}, {10, 10}}, studio.renderer().picture(0));
    CHECK_FALSE(studio.renderer().draw_over(*frame, overlay, studio.renderer().picture(0)).has_value());
    studio.gpu().need(studio.frames().submit(*frame));
    CHECK(test::largest_difference(studio.download(studio.renderer().picture(0)), main) == 0);
}

TEST_CASE("Inset: each eye of a stereo picture has it in the corner, with the picture's aspect ratio") {
    const Rectangle corner = inset_rectangle({1280, 720}, 0.25F);
    CHECK(corner.high - corner.low == glm::vec2(320, 180));
    CHECK(corner.high == glm::vec2(1262, 702));
    CHECK(inset_rectangle({3, 3}, 0.1F).low == glm::vec2(2, 2));  // at least one pixel

    using Multiview = RendererOptions::Multiview;
    for (const Multiview multiview : {Multiview::never, Multiview::always}) {
        RendererOptions options;
        options.multiview = multiview;
        test::Studio studio(options);
        const assets::Model model = test::sphere({}, 24);
        const GpuModel gpu_model = studio.upload(model);
        const EnvironmentLight light = studio.light(shading::studio_environment(64));
        Scene scene;
        add_model(scene, model, gpu_model);
        scene.environment = &light;
        Perspective lens;
        lens.aspect = 4.0F / 3.0F;
        const Eye eyes[] = {make_eye({-0.3F, 0, 4}, {0, 0, 0}, lens),
                            make_eye({0.3F, 0, 4}, {0, 0, 0}, lens)};
        Inset inset;
        inset.eye = make_eye({3, 3, 0}, {0, 0, 0}, lens);
        inset.place = inset_rectangle({120, 90}, 0.3F);
        const VkExtent2D own{36, 27};
        const Picture single = studio.shoot(scene, inset.eye, own);
        const std::vector<Picture> bare = studio.shoot(scene, eyes, {120, 90});
        const std::vector<Picture> made = studio.gpu().need(take_pictures(
            studio.gpu().device(), studio.frames(), studio.renderer(), scene, eyes, {120, 90}, {&inset, 1}));
        REQUIRE(made.size() == 2);
        const auto left = static_cast<std::uint32_t>(inset.place.low.x),
                   top = static_cast<std::uint32_t>(inset.place.low.y);
        for (std::size_t view = 0; view < 2; ++view)
            CHECK(wrong(
                      made[view],
                      [&](std::uint32_t x, std::uint32_t y) {
                          const bool inside = x >= left && x < left + 36 && y >= top && y < top + 27;
                          const bool framed = x + 2 >= left && x < left + 38 && y + 2 >= top && y < top + 29;
                          return inside   ? test::pixel(single, x - left, y - top)
                                 : framed ? glm::ivec4(235, 240, 245, 255)
                                          : test::pixel(bare[view], x, y);
                      },
                      1) == 0);
    }
}

}  // namespace render_overlay_test
