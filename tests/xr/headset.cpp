// The headset's client on a mock runtime that checks every call.
#include "tests/xr/headset_case.hpp"

#include <chrono>
#include <cstring>
#include <thread>

#include "engine/gpu/resources.hpp"

using namespace bolt;
using test::control;
using test::HeadsetCase;
namespace mock = bolt::mock_openxr;

namespace {

struct Pictures {
    gpu::Device& device;
    std::vector<gpu::Image> images{};
    std::vector<xr::EyePicture> eyes{};

    explicit Pictures(gpu::Device& of) : device(of) {}
    Pictures(Pictures&&) = default;
    Pictures& operator=(Pictures&&) = delete;
    ~Pictures() { (void)device.idle(); }  // it may still copy them
};

gpu::Image filled_image(gpu::Device& device, VkFormat format, VkExtent2D size, std::uint32_t seed) {
    const bool depth = format == VK_FORMAT_D32_SFLOAT;
    gpu::ImageInfo info;
    info.format = format;
    info.extent = size;
    info.usage =
        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (depth) info.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    gpu::Image image = test::need(gpu::Image::create(device, info));
    std::vector<std::uint32_t> texels;
    for (std::uint32_t i = 0; i < size.width * size.height; ++i) {
        const float share = static_cast<float>((i * 7 + seed) % 1000) / 1000.0F;
        std::uint32_t bits = i * 2654435761U + seed;
        if (depth) std::memcpy(&bits, &share, sizeof bits);
        texels.push_back(bits);
    }
    gpu::Buffer staging = test::need(
        gpu::upload_buffer(device, std::as_bytes(std::span(texels)), VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
    gpu::ImageRange range;
    range.aspect = info.aspect();
    test::need(gpu::submit_and_wait(device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::undefined, gpu::ResourceUse::transfer_to,
                           range);
        VkBufferImageCopy region{};
        region.imageSubresource = {range.aspect, 0, 0, 1};
        region.imageExtent = {size.width, size.height, 1};
        vkCmdCopyBufferToImage(commands, staging.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &region);
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::transfer_to,
                           gpu::ResourceUse::transfer_from, range);
    }));
    return image;
}

Pictures make_pictures(gpu::Device& device, VkExtent2D size) {
    Pictures pictures(device);
    for (std::uint32_t i = 0; i < 2; ++i) {
        pictures.images.push_back(filled_image(device, VK_FORMAT_R8G8B8A8_SRGB, size, 10 * i));
        pictures.images.push_back(filled_image(device, VK_FORMAT_D32_SFLOAT, size, 3 * i + 1));
    }
    for (std::size_t i = 0; i < 2; ++i)
        pictures.eyes.push_back({&pictures.images[2 * i], 0, &pictures.images[2 * i + 1], 0, size});
    return pictures;
}

std::vector<std::uint8_t> bytes_of(gpu::Device& device, const gpu::Image& image) {
    const auto texels =
        test::need(gpu::download_image(device, image, gpu::ResourceUse::transfer_from, 4, 0, 0));
    std::vector<std::uint8_t> bytes;
    for (const std::byte b : texels) bytes.push_back(static_cast<std::uint8_t>(b));
    return bytes;
}

bool has_event(const HeadsetCase& c, const auto& is) {
    return std::any_of(c.events.begin(), c.events.end(), is);
}

}  // namespace

TEST_CASE("Headset: without a runtime it is absent, says why once, and is found when a runtime appears") {
    HeadsetCase c;
    (void)setenv("XR_RUNTIME_JSON", "/nonexistent/runtime.json", 1);
    CHECK_FALSE(c.connect());
    CHECK_FALSE(c.connect());
    REQUIRE(c.headset->absence());
    CHECK(c.headset->absence()->code == ErrorCode::no_device);
    CHECK(c.headset->absence()->message().find("no OpenXR runtime") != std::string::npos);
    CHECK(c.headset->absence()->message().find("XR_RUNTIME_JSON") != std::string::npos);
    CHECK(c.log.size() == 1);
    CHECK_FALSE(c.headset->begin_frame(0.0));
    (void)setenv("XR_RUNTIME_JSON", BOLT_MOCK_MANIFEST, 1);
    CHECK(c.connect());
    CHECK_FALSE(c.headset->absence());
}

TEST_CASE("Headset: a runtime without a headset, without Vulkan, or for a newer Vulkan is named") {
    const auto absence = [](const mock::Config& config) {
        HeadsetCase c(config);
        CHECK_FALSE(c.connect());
        return c.headset->absence()->message();
    };
    mock::Config config;
    config.headset = false;
    CHECK(absence(config).find("no headset is connected to Mock OpenXR 1.2.3") != std::string::npos);
    config = {};
    config.extensions = {"XR_EXT_hand_tracking"};
    CHECK(absence(config).find("does not support Vulkan") != std::string::npos);
    config = {};
    config.needs_newer_vulkan = true;
    HeadsetCase c(config);
    const bool found = c.headset->find(1.0);
    const std::string why = found ? "" : c.headset->absence()->message();
    INFO(why);
    REQUIRE(found);
    gpu::InstanceOptions options;
    options.creator = c.headset->creator();
    const auto instance = gpu::Instance::create(options);
    REQUIRE_FALSE(instance);
    CHECK(instance.error().message().find("needs Vulkan 1.9") != std::string::npos);
}

TEST_CASE("Headset: it searches at most once a second") {
    HeadsetCase c;
    (void)setenv("XR_RUNTIME_JSON", "/nonexistent/runtime.json", 1);
    CHECK_FALSE(c.headset->find(10.0));
    (void)setenv("XR_RUNTIME_JSON", BOLT_MOCK_MANIFEST, 1);
    CHECK_FALSE(c.headset->find(10.5));
    CHECK(c.headset->find(11.1));
    CHECK_FALSE(c.headset->find(20.0));  // found already
}

TEST_CASE("Headset: from idle to focus, off and on again, and ended in the headset's menu") {
    HeadsetCase c;
    REQUIRE(c.connect());
    CHECK(c.headset->session().base_space() == xr::BaseSpace::stage);
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    CHECK(c.headset->running());
    CHECK(c.frame());
    CHECK(c.last.focused);

    control().send(mock::Event::lose_focus);
    (void)c.frame();
    CHECK(c.frame());
    CHECK_FALSE(c.last.focused);
    control().send(mock::Event::regain_focus);
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));

    control().send(mock::Event::take_off);
    CHECK_FALSE(c.frame());
    CHECK_FALSE(c.headset->running());
    CHECK(c.headset->connected());
    CHECK_FALSE(c.headset->begin_frame(0.0));
    control().send(mock::Event::put_on);
    CHECK(c.frame());
    CHECK(c.headset->running());

    control().send(mock::Event::user_exit);
    for (int i = 0; i < 5 && !c.headset->exit_requested(); ++i) (void)c.frame();
    CHECK(c.headset->exit_requested());
    CHECK_FALSE(c.headset->connected());
    CHECK_FALSE(c.headset->find(1e6));  // the user does not want the program any more
}

TEST_CASE("Headset: the program ends its session in order") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    c.headset->end();
    CHECK(control().state() == XR_SESSION_STATE_EXITING);
}

TEST_CASE(
    "Headset: pictures and depth arrive unchanged, in shared and in separate images, smaller ones too") {
    for (const bool separate : {false, true})
        for (const VkExtent2D size : {VkExtent2D{64, 48}, VkExtent2D{40, 30}}) {
            CAPTURE(separate);
            CAPTURE(size.width);
            mock::Config config;
            config.refuses_arrays = separate;
            HeadsetCase c(config);
            REQUIRE(c.connect());
            CHECK(c.headset->session().extent().width == 64);
            CHECK(c.headset->session().uses_depth());
            Pictures pictures = make_pictures(*c.device, size);
            c.images = pictures.eyes;
            control().record_pictures(true);
            REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
            REQUIRE(c.frame(true));
            const mock::FrameRecord shown = control().last_frame().value();
            REQUIRE(shown.layers);
            REQUIRE(shown.eyes.size() == 2);
            for (std::size_t eye = 0; eye < 2; ++eye) {
                const mock::EyeRecord& record = shown.eyes[eye];
                CHECK(record.layer == (separate ? 0 : eye));
                CHECK(record.width == size.width);
                CHECK(record.rgba == bytes_of(*c.device, pictures.images[2 * eye]));
                const std::vector<std::uint8_t> depth = bytes_of(*c.device, pictures.images[2 * eye + 1]);
                REQUIRE(record.depth.size() * sizeof(float) == depth.size());
                CHECK(std::memcmp(record.depth.data(), depth.data(), depth.size()) == 0);
                // Reversed: depth 0 is far.
                CHECK(record.depth_range.value()[0] == 100.0F);
                CHECK(record.depth_range.value()[1] == 0.05F);
                CHECK(glm::distance(record.pose.position, c.last.view.eyes[eye].pose.position) < 1e-6);
                CHECK(record.fov.angleLeft == doctest::Approx(c.last.view.eyes[eye].fov.left));
            }
            CHECK(glm::distance(shown.eyes[0].pose.position, shown.eyes[1].pose.position) ==
                  doctest::Approx(0.063));
        }
}

TEST_CASE("Headset: a runtime with blue first or with half floats gets the same colours") {
    for (const VkFormat format : {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT}) {
        mock::Config config;
        config.formats = {format};
        HeadsetCase c(config);
        REQUIRE(c.connect());
        CHECK_FALSE(c.headset->session().uses_depth());  // it has no format for it
        Pictures pictures = make_pictures(*c.device, {64, 48});
        c.images = pictures.eyes;
        control().record_pictures(true);
        REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
        REQUIRE(c.frame(true));
        const mock::FrameRecord shown = control().last_frame().value();
        REQUIRE(shown.eyes.size() == 2);
        CHECK_FALSE(shown.eyes[0].depth_range);
        if (format != VK_FORMAT_B8G8R8A8_SRGB) continue;
        const std::vector<std::uint8_t> source = bytes_of(*c.device, pictures.images[0]);
        bool same = true;
        for (std::size_t i = 0; i + 3 < source.size(); i += 4)
            same = same && shown.eyes[0].rgba[i] == source[i + 2] && shown.eyes[0].rgba[i + 2] == source[i];
        CHECK(same);
    }
}

TEST_CASE("Headset: an 8-bit sRGB format is preferred to the runtime's first, and linear 8-bit is refused") {
    const std::int64_t offered[] = {VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                                    VK_FORMAT_R8G8B8A8_SRGB};
    CHECK(xr::choose_color_format(offered) == VK_FORMAT_R8G8B8A8_SRGB);
    const std::int64_t linear[] = {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D32_SFLOAT};
    CHECK_FALSE(xr::choose_color_format(linear));
    CHECK(xr::choose_depth_format(linear) == VK_FORMAT_D32_SFLOAT);
    mock::Config config;
    config.formats = {VK_FORMAT_R8G8B8A8_UNORM};
    HeadsetCase c(config);
    CHECK_FALSE(c.connect());
    CHECK(c.headset->absence()->message().find("no usable image format") != std::string::npos);
}

TEST_CASE("Headset: nothing is submitted while it would not be seen, or while the head's pose is unknown") {
    HeadsetCase c;
    REQUIRE(c.connect());
    Pictures pictures = make_pictures(*c.device, {64, 48});
    c.images = pictures.eyes;
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    control().should_render(false);
    (void)c.frame(true);
    REQUIRE(c.frame(true));
    CHECK_FALSE(c.last.timing.should_render);
    CHECK_FALSE(control().last_frame()->layers);
    control().should_render(true);
    control().set_head({{}, false, false});
    (void)c.frame(true);
    REQUIRE(c.frame(true));
    CHECK(c.last.view.eyes.empty());
    CHECK_FALSE(control().last_frame()->layers);
    control().set_head({{{0.3, 1.5, -0.2}, rotation(Vec3(0.1, 0.4, -0.2))}, true, false});
    (void)c.frame(true);
    REQUIRE(c.frame(true));
    CHECK_FALSE(c.last.view.tracked);
    CHECK(glm::distance(c.last.view.head.position, Vec3(0.3, 1.5, -0.2)) < 1e-6);
    CHECK(control().last_frame()->layers);
}

TEST_CASE("Headset: the loss of session or instance in any call of a frame ends it, and it is found again") {
    for (const char* function :
         {"xrPollEvent", "xrWaitFrame", "xrBeginFrame", "xrSyncActions", "xrGetActionStatePose",
          "xrLocateSpace", "xrLocateViews", "xrAcquireSwapchainImage", "xrWaitSwapchainImage",
          "xrReleaseSwapchainImage", "xrEndFrame", "xrLocateHandJointsEXT"})
        for (const XrResult loss : {XR_ERROR_SESSION_LOST, XR_ERROR_INSTANCE_LOST}) {
            CAPTURE(function);
            CAPTURE(loss);
            HeadsetCase c;
            REQUIRE(c.connect());
            {
                Pictures pictures = make_pictures(*c.device, {64, 48});
                c.images = pictures.eyes;
                REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
                control().fail_next(function, loss, 1);
                for (int i = 0; i < 3 && c.headset->connected(); ++i) (void)c.frame(true);
            }
            CHECK_FALSE(c.headset->connected());
            REQUIRE(c.headset->absence());
            CHECK(c.headset->absence()->lost);
            CHECK(c.log.back().find("the headset is lost") != std::string::npos);
            REQUIRE(c.connect());
            CHECK(c.reach(XR_SESSION_STATE_FOCUSED));
        }
}

TEST_CASE("Headset: LOSS_PENDING and an instance that dies without an event end the session at once") {
    for (const mock::Event event : {mock::Event::lose_session, mock::Event::lose_instance}) {
        HeadsetCase c;
        REQUIRE(c.connect());
        REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
        control().send(event);
        (void)c.frame();
        CHECK_FALSE(c.headset->connected());
    }
}

TEST_CASE("Headset: a session that cannot be created leaves the program at the desk") {
    for (const char* function : {"xrCreateSession", "xrCreateReferenceSpace", "xrEnumerateSwapchainFormats",
                                 "xrCreateActionSet", "xrAttachSessionActionSets"}) {
        CAPTURE(function);
        HeadsetCase c;
        control().fail_next(function, XR_ERROR_RUNTIME_FAILURE, 1);
        CHECK_FALSE(c.connect());
        REQUIRE(c.headset->absence());
        CHECK(c.headset->absence()->message().find("XR_ERROR_RUNTIME_FAILURE") != std::string::npos);
        CHECK_FALSE(c.headset->find(c.now + 1.5));  // not every second
        CHECK(c.headset->find(c.now + 2.5));
    }
}

TEST_CASE(
    "Headset: a runtime that never releases a frame delays nobody, and is left without waiting for it") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    control().block_frames(true);
    (void)c.frame();  // it was released before
    const auto begin = std::chrono::steady_clock::now();
    CHECK_FALSE(c.headset->begin_frame(0.02));
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(2));
    control().block_frames(false);
    CHECK(c.frame());
}

TEST_CASE("Headset: a change of origin is reported for the space that is used, with its shift") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    c.events.clear();
    control().send(mock::Event::recentre_local);
    (void)c.frame();
    const auto recentred = [](const xr::SessionEvent& e) { return std::holds_alternative<xr::Recentred>(e); };
    CHECK_FALSE(has_event(c, recentred));
    control().send(mock::Event::recentre);
    (void)c.frame();
    REQUIRE(has_event(c, recentred));
    for (const xr::SessionEvent& event : c.events)
        if (const auto* shift = std::get_if<xr::Recentred>(&event))
            CHECK(glm::distance(shift->shift.value().position, Vec3(0.1, 0.0, 0.0)) < 1e-6);
    for (const mock::Event other :
         {mock::Event::profile_changed, mock::Event::mask_changed, mock::Event::events_lost})
        control().send(other);
    (void)c.frame();
    CHECK(has_event(
        c, [](const xr::SessionEvent& e) { return std::holds_alternative<xr::BindingsChanged>(e); }));
    CHECK(has_event(
        c, [](const xr::SessionEvent& e) { return std::holds_alternative<xr::VisibilityMaskChanged>(e); }));
    CHECK(has_event(c, [](const xr::SessionEvent& e) { return std::holds_alternative<xr::EventsLost>(e); }));
}

TEST_CASE("Headset: the base space is the stage, else the floor, else the seated user's") {
    mock::Config config;
    config.stage = false;
    {
        HeadsetCase c(config);
        REQUIRE(c.connect());
        CHECK(c.headset->session().base_space() == xr::BaseSpace::floor);
    }
    std::erase(config.extensions, "XR_EXT_local_floor");
    {
        HeadsetCase c(config);
        REQUIRE(c.connect());
        CHECK(c.headset->session().base_space() == xr::BaseSpace::seated);
    }
    xr::SessionOptions seated;
    seated.seated = true;
    HeadsetCase c({}, seated);
    REQUIRE(c.connect());
    CHECK(c.headset->session().base_space() == xr::BaseSpace::seated);
}

TEST_CASE("Headset: a display for one eye, and surroundings behind the picture where they can be shown") {
    mock::Config config;
    config.eyes = 1;
    {
        HeadsetCase c(config);
        REQUIRE(c.connect());
        REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
        CHECK(c.last.view.eyes.size() == 1);
    }
    config = {};
    config.blend_modes = {XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND};
    xr::SessionOptions passthrough;
    passthrough.passthrough = true;
    HeadsetCase c(config, passthrough);
    REQUIRE(c.connect());
    CHECK(c.reach(XR_SESSION_STATE_FOCUSED));
}
