#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/support/need.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

constexpr std::int64_t srgb = VK_FORMAT_R8G8B8A8_SRGB, bgra = VK_FORMAT_B8G8R8A8_SRGB,
                       half = VK_FORMAT_R16G16B16A16_SFLOAT, depth_format = VK_FORMAT_D32_SFLOAT;
constexpr VkExtent2D full{64, 48};

struct Setup {
    std::int64_t format = srgb;
    bool refuse_arrays = false;
    bool separate_eyes = false;
    bool depth = true;
    std::uint32_t eyes = 2;
    bool source_array = true;  // one source image with a layer an eye, else one an eye
    VkExtent2D drawn = full;
};

// Texels of a layer a view, different everywhere.
std::vector<std::uint8_t> random_texels(std::uint32_t layers, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::uint8_t> texels(std::size_t{4} * full.width * full.height * layers);
    for (std::uint8_t& texel : texels) texel = static_cast<std::uint8_t>(random());
    return texels;
}
std::vector<std::uint8_t> random_depth(std::uint32_t layers) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> between(0.0F, 1.0F);
    std::vector<float> depth(std::size_t{1} * full.width * full.height * layers);
    for (float& value : depth) value = between(random);
    std::vector<std::uint8_t> bytes(depth.size() * sizeof(float));
    std::memcpy(bytes.data(), depth.data(), bytes.size());
    return bytes;
}

// The part of a layer that is drawn.
std::vector<std::uint8_t> part(const std::vector<std::uint8_t>& texels, std::uint32_t layer,
                               VkExtent2D extent) {
    std::vector<std::uint8_t> rows;
    for (std::uint32_t y = 0; y < extent.height; ++y) {
        const auto* row = texels.data() + std::size_t{4} * full.width * (y + full.height * layer);
        rows.insert(rows.end(), row, row + std::size_t{4} * extent.width);
    }
    return rows;
}

int largest_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    REQUIRE(a.size() == b.size());
    int largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(int{a[i]} - int{b[i]}));
    return largest;
}

// The last frame that a program submits which draws random pictures.
struct Drawn {
    mock::Frame frame;
    std::vector<std::uint8_t> color, depth;
};

Drawn draw(const test::MockRuntime& mock, const Setup& setup) {
    xr::HeadsetOptions options;
    options.session.separate_eyes = setup.separate_eyes;
    test::Program program(options);
    REQUIRE(program.connect());
    Drawn drawn{{}, random_texels(setup.eyes, 3), random_depth(setup.eyes)};
    std::vector<const gpu::Image*> colors, depths;
    std::vector<xr::EyePicture> pictures;
    const std::uint32_t images = setup.source_array ? 1 : setup.eyes;
    for (std::uint32_t i = 0; i < images; ++i) {
        const auto layer = [&](const std::vector<std::uint8_t>& texels) {
            return setup.source_array ? texels : part(texels, i, full);
        };
        const std::uint32_t layers = setup.source_array ? setup.eyes : 1;
        colors.push_back(&program.make_image(VK_FORMAT_R8G8B8A8_SRGB, full, layers, layer(drawn.color)));
        depths.push_back(&program.make_image(VK_FORMAT_D32_SFLOAT, full, layers, layer(drawn.depth)));
    }
    for (std::uint32_t eye = 0; eye < setup.eyes; ++eye) {
        const std::uint32_t image = setup.source_array ? 0 : eye, layer = setup.source_array ? eye : 0;
        pictures.push_back({colors[image], layer, setup.depth ? depths[image] : nullptr, layer, setup.drawn});
    }
    program.set_pictures(pictures);
    program.set_depth_range({0.03F, 250.0F});
    mock->set_capture(true);
    (void)program.focus();
    for (int i = 0; i < 4; ++i) (void)program.frame();
    drawn.frame = mock->take_frames().back();
    program.disconnect();
    return drawn;
}

void check_depth(const Drawn& drawn, std::uint32_t eye, VkExtent2D extent) {
    const mock::SubmittedView& view = drawn.frame.views[eye];
    REQUIRE(view.has_depth);
    CHECK(view.min_depth == 0.0F);
    CHECK(view.max_depth == 1.0F);
    CHECK(view.near_z == 250.0F);  // reversed: depth 0 is far
    CHECK(view.far_z == 0.03F);
    const std::vector<std::uint8_t> expected = part(drawn.depth, eye, extent);
    REQUIRE(view.picture.depth.size() * sizeof(float) == expected.size());
    CHECK(std::memcmp(view.picture.depth.data(), expected.data(), expected.size()) == 0);
}

void check_pictures(const Setup& setup) {
    CAPTURE(setup.format);
    CAPTURE(setup.refuse_arrays);
    CAPTURE(setup.separate_eyes);
    CAPTURE(setup.source_array);
    mock::Config config;
    config.formats = {setup.format, depth_format};
    config.refuse_arrays = setup.refuse_arrays;
    config.eyes = setup.eyes;
    const test::MockRuntime mock(config);
    const Drawn drawn = draw(mock, setup);
    REQUIRE(drawn.frame.views.size() == setup.eyes);
    const bool arrays = !setup.refuse_arrays && !setup.separate_eyes;
    for (std::uint32_t eye = 0; eye < setup.eyes; ++eye) {
        const mock::SubmittedView& view = drawn.frame.views[eye];
        CHECK(view.layer == (arrays ? eye : 0));
        CHECK(view.rect.offset.x == 0);
        CHECK(view.rect.offset.y == 0);
        CHECK(view.rect.extent.width == static_cast<std::int32_t>(setup.drawn.width));
        CHECK(view.rect.extent.height == static_cast<std::int32_t>(setup.drawn.height));
        // Half floats have 11 bits: near white a step of 8 bits is twelve of theirs.
        CHECK(largest_difference(view.picture.rgba, part(drawn.color, eye, setup.drawn)) <=
              (setup.format == half ? 1 : 0));
        if (setup.depth)
            check_depth(drawn, eye, setup.drawn);
        else
            CHECK_FALSE(view.has_depth);
    }
}

}  // namespace

TEST_CASE("Pictures: arrive bit by bit, in every format, in arrays and in separate swapchains") {
    for (const std::int64_t format : {srgb, bgra, half})
        for (const bool source_array : {true, false}) {
            check_pictures({format, false, false, true, 2, source_array});
            check_pictures({format, true, false, true, 2, source_array});
            check_pictures({format, false, true, true, 2, source_array});
        }
}

TEST_CASE("Pictures: a smaller picture fills a part of the image") {
    for (const bool refuse_arrays : {false, true})
        check_pictures({srgb, refuse_arrays, false, true, 2, true, {40, 24}});
}

TEST_CASE("Pictures: a mono headset gets one picture") { check_pictures({srgb, false, false, true, 1}); }

TEST_CASE("Pictures: without depth none is submitted") { check_pictures({srgb, false, false, false}); }

TEST_CASE("Pictures: arrays of colours go with separate swapchains of depth") {
    mock::Config config;
    config.formats = {srgb, depth_format};
    const test::MockRuntime mock(config);
    mock->fail_after("xrCreateSwapchain", 1, XR_ERROR_FEATURE_UNSUPPORTED, 1);
    const Drawn drawn = draw(mock, {});
    REQUIRE(drawn.frame.views.size() == 2);
    CHECK(mock->calls("xrCreateSwapchain") == 4);
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        CHECK(drawn.frame.views[eye].layer == eye);
        CHECK(drawn.frame.views[eye].picture.rgba == part(drawn.color, eye, full));
        check_depth(drawn, eye, full);
    }
}

TEST_CASE("Pictures: a runtime without depth layers gets none") {
    mock::Config config;
    config.extensions = {"XR_KHR_vulkan_enable2"};
    const test::MockRuntime mock(config);
    const Drawn drawn = draw(mock, {});
    CHECK_FALSE(drawn.frame.views[0].has_depth);
}

TEST_CASE("Pictures: the options switch depth off and the passthrough on") {
    mock::Config config;
    config.blend_modes.push_back(XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND);
    const test::MockRuntime mock(config);
    for (const bool on : {false, true}) {
        xr::HeadsetOptions options;
        options.session.submit_depth = false;
        test::Program program(options);
        program.set_passthrough(on);
        REQUIRE(program.connect());
        CHECK_FALSE(program.headset().session().uses_depth());
        (void)program.focus();
        (void)program.frame();
        const mock::Frame frame = mock->take_frames().back();
        CHECK(frame.blend_mode ==
              (on ? XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND : XR_ENVIRONMENT_BLEND_MODE_OPAQUE));
        CHECK((frame.flags == XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT) == on);
    }
}

TEST_CASE("Pictures: passthrough is not requested from a headset without it") {
    const test::MockRuntime mock;
    test::Program program;
    program.set_passthrough(true);
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK(mock->take_frames().back().blend_mode == XR_ENVIRONMENT_BLEND_MODE_OPAQUE);
}

TEST_CASE("Pictures: glasses without an opaque mode get their own") {
    mock::Config config;
    config.blend_modes = {XR_ENVIRONMENT_BLEND_MODE_ADDITIVE};
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK(mock->take_frames().back().blend_mode == XR_ENVIRONMENT_BLEND_MODE_ADDITIVE);
}

TEST_CASE("Pictures: the format of colours is chosen by its encoding, not by the runtime's order") {
    CHECK(xr::choose_color_format(std::vector<std::int64_t>{91, 37, half, bgra, srgb}) ==
          VK_FORMAT_R8G8B8A8_SRGB);
    CHECK(xr::choose_color_format(std::vector<std::int64_t>{91, half, bgra}) == VK_FORMAT_B8G8R8A8_SRGB);
    CHECK(xr::choose_color_format(std::vector<std::int64_t>{91, half}) == VK_FORMAT_R16G16B16A16_SFLOAT);
    // UNORM would be read as linear: paler.
    CHECK_FALSE(xr::choose_color_format(std::vector<std::int64_t>{37, 44, 91}).has_value());
    CHECK_FALSE(xr::choose_color_format({}).has_value());
    CHECK(xr::choose_depth_format(std::vector<std::int64_t>{124, depth_format}) == VK_FORMAT_D32_SFLOAT);
    CHECK_FALSE(xr::choose_depth_format(std::vector<std::int64_t>{124, 129}).has_value());
}

TEST_CASE("Pictures: an image that the runtime still reads leaves one frame empty") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    (void)program.frame();
    (void)mock->take_frames();
    mock->fail_next("xrWaitSwapchainImage", XR_TIMEOUT_EXPIRED, 1);
    for (int i = 0; i < 3; ++i) (void)program.frame();
    const std::vector<mock::Frame> frames = mock->take_frames();
    REQUIRE(frames.size() == 3);
    CHECK_FALSE(frames[0].has_layer);
    CHECK(frames[1].has_layer);
    CHECK(frames[2].has_layer);
}
