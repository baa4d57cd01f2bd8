// Multiview: each layer equals a single picture of its view. Compute shaders draw the same as fragment
// shaders.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "engine/render/passes/pass.hpp"
#include "tests/render/support.hpp"
#include "tests/support/skip.hpp"

namespace render_multiview_test {

using namespace bolt;
using namespace bolt::render;

namespace {

using Multiview = RendererOptions::Multiview;

constexpr VkExtent2D extent{96, 72};

RendererOptions with(Multiview multiview, ScreenStage stage = ScreenStage::fragment) {
    RendererOptions options;
    options.multiview = multiview;
    options.screen_stage = stage;
    options.keep_depth = true;
    return options;
}

// Balls on a floor under a lamp, one of them a ghost, all well inside the picture.
struct Still {
    test::Studio studio;
    assets::Model ball, floor;
    GpuModel gpu_ball, gpu_floor;
    EnvironmentLight light = studio.light(shading::studio_environment(64));
    Scene scene;

    explicit Still(Multiview multiview, ScreenStage stage = ScreenStage::fragment)
        : Still(with(multiview, stage)) {}
    explicit Still(const RendererOptions& options) : studio(options) {
        assets::Material metal;
        metal.base_color = {0.9F, 0.6F, 0.3F, 1.0F};
        metal.roughness = 0.3F;
        ball = test::sphere(metal, 24);
        assets::Material dull;
        dull.metallic = 0.0F;
        dull.roughness = 0.8F;
        floor = test::plate(dull);
        gpu_ball = studio.upload(ball);
        gpu_floor = studio.upload(floor);
        for (const float x : {-2.2F, 0.0F, 2.2F}) {
            glm::mat4 world(1.0F);
            world[3] = {x, 0.2F * x, -0.3F * x, 1.0F};
            add_model(scene, ball, gpu_ball, world);
        }
        scene.objects[1].opacity = 0.4F;
        glm::mat4 world(3.0F);
        world[3] = {0, -1.6F, 0, 1};
        add_model(scene, floor, gpu_floor, world);
        SceneLight lamp;
        lamp.light.direction = {-0.4F, -0.8F, -0.3F, 0.0F};
        lamp.light.color = {2, 2, 2, 0};
        lamp.casts_shadow = true;
        scene.lights.push_back(lamp);
        scene.environment = &light;
    }
};

std::vector<Eye> eyes(std::size_t count) {
    Perspective p;
    p.fov = 0.7F;
    p.aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
    std::vector<Eye> all;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = -0.4F + 0.8F * static_cast<float>(i);
        all.push_back(make_eye({x, 2.5F, 13}, {0.1F * x, 0, 0}, p));
    }
    return all;
}

// Returns the largest difference between views drawn in one pass and views drawn separately.
int largest_difference(Still& together, Still& alone, std::size_t views) {
    const std::vector<Eye> from = eyes(views);
    const std::vector<Picture> pictures = together.studio.shoot(together.scene, from, extent);
    REQUIRE(pictures.size() == views);
    int largest = 0;
    for (std::size_t i = 0; i < views; ++i)
        largest = std::max(
            largest, test::largest_difference(pictures[i], alone.studio.shoot(alone.scene, from[i], extent)));
    return largest;
}

// The share of pixels that differ by more than a rounding error. The radius of ambient occlusion in pixels is
// a small difference of large numbers, so two pipelines of a GPU round it differently, and single samples
// read another texel: 2.9 % of the pixels on an NVIDIA H200, none on lavapipe.
double differing_share(Still& together, Still& alone, std::size_t views) {
    const std::vector<Eye> from = eyes(views);
    const std::vector<Picture> pictures = together.studio.shoot(together.scene, from, extent);
    std::size_t differing = 0, all = 0;
    for (std::size_t i = 0; i < views; ++i) {
        const Picture single = alone.studio.shoot(alone.scene, from[i], extent);
        REQUIRE(single.rgba.size() == pictures[i].rgba.size());
        all += single.rgba.size() / 4;
        for (std::size_t at = 0; at < single.rgba.size(); at += 4) {
            int most = 0;
            for (std::size_t c = at; c < at + 4; ++c)
                most = std::max(most, std::abs(int{single.rgba[c]} - int{pictures[i].rgba[c]}));
            differing += most > 1 ? 1 : 0;
        }
    }
    return static_cast<double>(differing) / static_cast<double>(all);
}

}  // namespace

TEST_CASE("Multiview: two and four views equal single pictures in every pass") {
    Still together(Multiview::always), alone(Multiview::never);
    const auto change = [&](auto how) {
        how(together.scene);
        how(alone.scene);
    };
    const auto same = [&](const char* what) {
        const std::string drawn(what);
        CAPTURE(drawn);
        for (const std::size_t views : {std::size_t{2}, std::size_t{4}}) {
            if (together.scene.occlusion_radius > 0.0F)
                CHECK(differing_share(together, alone, views) <= 0.05);
            else
                CHECK(largest_difference(together, alone, views) <= 1);
        }
    };
    same("shadow, ghost and sky");
    change([](Scene& scene) { scene.background = {0.3F, 0.32F, 0.35F, 1.0F}; });
    same("a plain background");
    change([](Scene& scene) { scene.occlusion_radius = 0.8F; });
    same("ambient occlusion");
    change([](Scene& scene) {
        scene.objects[2].outline = {1.0F, 0.6F, 0.0F, 0.8F};
        scene.objects[0].cut = true;
        scene.cut_away = {{-2.2F, -0.6F, -1.0F}, 0.5F, 1.0F};
    });
    same("an outline and a cut-away");
    // Negative control: the views differ from each other and from another scene.
    const std::vector<Picture> pictures = together.studio.shoot(together.scene, eyes(2), extent);
    CHECK(test::largest_difference(pictures[0], pictures[1]) > 20);
    together.scene.objects[0].world[3].x += 1.0F;
    CHECK(largest_difference(together, alone, 2) > 20);
    together.scene.background = {0.6F, 0.32F, 0.35F, 1.0F};
    CHECK(differing_share(together, alone, 2) > 0.2);
}

TEST_CASE("Move eyes: pictures are those of eyes that were there from the beginning, also at the edges") {
    for (const Multiview multiview : {Multiview::always, Multiview::never}) {
        CAPTURE(multiview == Multiview::always);
        const auto still = [&](float margin) {
            RendererOptions options = with(multiview);
            options.margin = margin;
            auto made = std::make_unique<Still>(options);
            made->scene.occlusion_radius = 0.8F;
            made->scene.objects[2].outline = {1.0F, 0.6F, 0.0F, 0.8F};
            made->scene.objects[0].cut = true;
            made->scene.cut_away = {{-2.2F, -0.6F, -1.0F}, 0.5F, 1.0F};
            // Just outside the picture of the eyes before.
            glm::mat4 world(0.2F);
            world[3] = {6.66F, 0.0F, 0.0F, 1.0F};
            add_model(made->scene, made->ball, made->gpu_ball, world);
            return made;
        };
        const auto eyes_at = [](float x) {
            Perspective p{0.7F, 4.0F / 3.0F};
            return std::vector<Eye>{make_eye({x, 0, 13}, {x, 0, 0}, p),
                                    make_eye({x + 0.1F, 0, 13}, {x + 0.1F, 0, 0}, p)};
        };
        const auto moved = [&](Still& drawn) {
            gpu::FrameContext& frame = *drawn.studio.gpu().need(drawn.studio.frames().begin());
            drawn.studio.gpu().need(
                drawn.studio.renderer().render(frame, drawn.scene, eyes_at(0.0F), extent));
            drawn.studio.renderer().move_eyes(eyes_at(0.5F));
            drawn.studio.gpu().need(drawn.studio.frames().submit(frame));
            return std::vector<Picture>{drawn.studio.download(drawn.studio.renderer().picture(0)),
                                        drawn.studio.download(drawn.studio.renderer().picture(1))};
        };
        const std::unique_ptr<Still> wide = still(0.1F), narrow = still(0.0F);
        const std::vector<Picture> expected = wide->studio.shoot(wide->scene, eyes_at(0.5F), extent),
                                   with_margin = moved(*wide), without = moved(*narrow);
        for (std::size_t view = 0; view < 2; ++view) {
            CHECK(with_margin[view].rgba == expected[view].rgba);
            CHECK(without[view].rgba != expected[view].rgba);  // control: the ball at the edge is missing
        }
    }
}

TEST_CASE("Screen stage: compute shaders light and occlude as fragment shaders do") {
    for (const Multiview multiview : {Multiview::never, Multiview::always}) {
        CAPTURE(multiview);
        Still computed(multiview, ScreenStage::compute), drawn(multiview);
        const auto change = [&](auto how) {
            how(computed.scene);
            how(drawn.scene);
        };
        const auto differ_at_most = [&](std::size_t views) {
            const std::vector<Eye> from = eyes(views);
            const std::vector<Picture> a = computed.studio.shoot(computed.scene, from, extent),
                                       b = drawn.studio.shoot(drawn.scene, from, extent);
            int largest = 0;
            for (std::size_t i = 0; i < views; ++i)
                largest = std::max(largest, test::largest_difference(a[i], b[i]));
            return largest;
        };
        CHECK(differ_at_most(2) <= 1);  // also the sky, in every pixel without a ball or the floor
        change([](Scene& scene) {
            scene.background = {0.3F, 0.32F, 0.35F, 1.0F};
            scene.occlusion_radius = 0.8F;
            scene.objects[0].tint = {0.1F, 0.5F, 0.9F, 0.7F};  // stored per pixel
            scene.objects[2].outline = {1.0F, 0.6F, 0.0F, 0.8F};
        });
        // Ambient occlusion differs in some pixels on GPUs (see differing_share).
        CHECK(differing_share(computed, drawn, 1) <= 0.05);
        CHECK(differing_share(computed, drawn, 2) <= 0.05);
        // Negative control: without occlusion, and without the tint, the pictures differ.
        drawn.scene.occlusion_radius = 0.0F;
        CHECK(differ_at_most(2) > 5);
        drawn.scene.occlusion_radius = 0.8F;
        drawn.scene.objects[0].tint.w = 0.0F;
        CHECK(differ_at_most(2) > 20);
    }
}

TEST_CASE("Hidden area: nothing is drawn there, and nothing else changes") {
    // The left third of the first view, and the right third of the second.
    const auto strip = [](float left, float right) {
        return std::make_shared<const std::vector<glm::vec2>>(
            std::vector<glm::vec2>{{left, -1}, {right, -1}, {left, 1}, {left, 1}, {right, -1}, {right, 1}});
    };
    for (const ScreenStage stage : {ScreenStage::fragment, ScreenStage::compute}) {
        for (const Multiview multiview : {Multiview::never, Multiview::always}) {
            CAPTURE(stage);
            CAPTURE(multiview);
            Still still(multiview, stage);
            still.scene.occlusion_radius = 0.8F;
            still.scene.objects[0].tint = {0.1F, 0.5F, 0.9F, 0.7F};
            std::vector<Eye> from = eyes(2);
            const std::vector<Picture> whole = still.studio.shoot(still.scene, from, extent);
            from[0].hidden = strip(-1.0F, -1.0F / 3.0F);
            from[1].hidden = strip(1.0F / 3.0F, 1.0F);
            const std::vector<Picture> covered = still.studio.shoot(still.scene, from, extent);
            // Ambient occlusion sees the strip's edge up to its reach.
            constexpr std::uint32_t edge = 16;
            int most_inside = 0, most_outside = 0, visible_before = 0;
            for (std::size_t view = 0; view < 2; ++view)
                for (std::size_t at = 0; at < whole[view].rgba.size(); at += 4) {
                    const auto x = static_cast<std::uint32_t>(at / 4 % extent.width);
                    const std::uint32_t from_edge = view == 0 ? x : extent.width - 1 - x;
                    for (std::size_t c = at; c < at + 3; ++c) {
                        const int now = covered[view].rgba[c], before = whole[view].rgba[c];
                        if (from_edge < extent.width / 3) {
                            most_inside = std::max(most_inside, now);
                            visible_before = std::max(visible_before, before);
                        } else if (from_edge >= extent.width / 3 + edge) {
                            most_outside = std::max(most_outside, std::abs(now - before));
                        }
                    }
                }
            for (std::uint32_t view = 0; view < 2; ++view) {
                const ImageLayer kept = still.studio.renderer().depth(view);
                const auto bytes = still.studio.gpu().need(
                    gpu::download_image(still.studio.device(), *kept.image, gpu::ResourceUse::transfer_from,
                                        sizeof(float), 0, kept.layer));
                std::vector<float> depth(bytes.size() / sizeof(float));
                std::memcpy(depth.data(), bytes.data(), bytes.size());
                float nearest_inside = 0.0F, nearest_outside = 0.0F;
                for (std::size_t at = 0; at < depth.size(); ++at) {
                    const auto x = static_cast<std::uint32_t>(at % extent.width);
                    const bool inside = (view == 0 ? x : extent.width - 1 - x) < extent.width / 3;
                    float& nearest = inside ? nearest_inside : nearest_outside;
                    nearest = std::max(nearest, depth[at]);
                }
                CHECK(nearest_inside == 0.0F);
                CHECK(nearest_outside > 0.0F);
                CHECK(nearest_outside < 1.0F);
            }
            CHECK(most_inside == 0);
            CHECK(visible_before > 100);
            CHECK(most_outside <= 1);
        }
    }
}

TEST_CASE("Transparent background: alpha is the covered share of a pixel, and colours are multiplied by it") {
    for (const ScreenStage stage : {ScreenStage::fragment, ScreenStage::compute}) {
        CAPTURE(stage);
        Still still(Multiview::never, stage);
        still.scene.objects[1].opacity = 1.0F;
        still.scene.background = {0.0F, 0.0F, 0.0F, 1.0F};
        const Picture on_black = still.studio.shoot(still.scene, eyes(1)[0], extent);
        still.scene.transparent = true;
        const Picture transparent = still.studio.shoot(still.scene, eyes(1)[0], extent);
        std::size_t clear = 0, covered = 0, partly = 0;
        int most = 0;
        for (std::size_t at = 0; at < transparent.rgba.size(); at += 4) {
            const int alpha = transparent.rgba[at + 3];
            (alpha == 0 ? clear : alpha == 255 ? covered : partly) += 1;
            for (std::size_t c = at; c < at + 3; ++c)
                most = std::max(most, std::abs(int{transparent.rgba[c]} - int{on_black.rgba[c]}));
            CHECK(on_black.rgba[at + 3] == 255);
        }
        CHECK(most <= 1);  // a colour on black is multiplied by the covered share, too
        CHECK(clear > 1000);
        CHECK(covered > 1000);
        CHECK(partly > 20);
    }
}

TEST_CASE("Transparent background: ghosts, outlines, labels and panels cover it as they cover a plain one") {
    const auto linear = [](double encoded) {
        const double c = encoded / 255.0;
        return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
    };
    Still still(Multiview::never);
    still.scene.objects[1].opacity = 1.0F;
    PanelPicture panel = still.studio.gpu().need(PanelPicture::create(still.studio.device(), {16, 16}));
    gpu::FrameContext& frame = *still.studio.gpu().need(still.studio.frames().begin());
    panel.clear(frame);
    Overlay overlay;
    add_rectangle(overlay, {{0.0F, 0.0F}, {16.0F, 16.0F}}, {0.2F, 0.4F, 0.6F, 0.5F});
    still.studio.gpu().need(still.studio.renderer().draw_over(frame, overlay, panel.layer()));
    still.studio.gpu().need(still.studio.frames().submit(frame));
    const std::vector<std::pair<const char*, std::function<void(Scene&)>>> additions{
        {"ghost", [](Scene& scene) { scene.objects[1].opacity = 0.4F; }},
        {"outline",
         [](Scene& scene) {
             scene.objects[2].outline = {1.0F, 0.6F, 0.0F, 0.8F};
         }},
        {"label",
         [](Scene& scene) {
             Label label;
             label.text = "M16";
             label.position = {0.0F, 3.5F, 0.0F};
             label.height = 12.0F;
             label.plate = {0.1F, 0.1F, 0.1F, 0.5F};
             scene.labels = {label};
         }},
        {"panel",
         [&](Scene& scene) {
             scene.panels.push_back({&panel.image(), {0, 3.5F, 0}, {1.0F, 0, 0}, {0, 0.5F, 0}, 1.0F});
         }},
    };
    for (const auto& [name, add] : additions) {
        const std::string addition = name;
        CAPTURE(addition);
        Scene scene = still.scene;
        scene.background = {0.0F, 0.0F, 0.0F, 1.0F};
        scene.transparent = true;
        const Picture without = still.studio.shoot(scene, eyes(1)[0], extent);
        add(scene);
        const Picture transparent = still.studio.shoot(scene, eyes(1)[0], extent);
        scene.transparent = false;
        scene.background = {0.3F, 0.32F, 0.35F, 1.0F};
        const Picture plain = still.studio.shoot(scene, eyes(1)[0], extent);
        const glm::ivec4 background = test::pixel(plain, 0, 0);
        REQUIRE(test::pixel(transparent, 0, 0) == glm::ivec4(0));
        double most = 0.0;
        std::size_t changed = 0;
        for (std::size_t at = 0; at < transparent.rgba.size(); at += 4) {
            const double alpha = transparent.rgba[at + 3] / 255.0;
            changed += transparent.rgba[at + 3] != without.rgba[at + 3] ? 1U : 0U;
            for (std::size_t c = 0; c < 3; ++c) {
                const double over = linear(transparent.rgba[at + c]) +
                                    (1.0 - alpha) * linear(background[static_cast<int>(c)]);
                most = std::max(most, std::abs(over - linear(plain.rgba[at + c])));
            }
        }
        CHECK(changed > 20);  // the addition covers a part of the background
        CHECK(most < 0.01);   // of the radiance of white; alpha has steps of 0.004
    }
}

TEST_CASE(
    "Multiview: objects that cross the picture's edge are in every layer where the driver clips correctly") {
    Still together(Multiview::always), alone(Multiview::never), chosen(Multiview::where_it_works);
    for (Still* still : {&together, &alone, &chosen}) {
        still->scene.background = {0.3F, 0.32F, 0.35F, 1.0F};
        still->scene.objects.back().world = glm::mat4(50.0F);
        still->scene.objects.back().world[3] = {0, -1.6F, 0, 1};
    }
    CHECK(largest_difference(chosen, alone, 2) <= 1);
    CHECK(largest_difference(chosen, alone, 3) <= 1);
    gpu::Device& device = together.studio.device();
    test::Gpu& gpu = together.studio.gpu();
    const gpu::PipelineCache cache = gpu.need(gpu::PipelineCache::open(device, {}));
    const int largest = largest_difference(together, alone, 2);
    CAPTURE(largest);
    if (!gpu.need(multiview_works(device, cache))) {
        CHECK_MESSAGE(largest > 1, "the renderer could draw the views in one pass");
        return test::skip_rest("equal layers: " + device.driver() +
                               " draws clipped triangles into the wrong layer");
    }
    CHECK(largest <= 1);
}

}  // namespace render_multiview_test
