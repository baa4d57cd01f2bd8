// The preview in a window with a simulated user and a GPU that is lost.
#include "tools/author/preview/preview.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <optional>
#include <thread>

#include "engine/gpu/device.hpp"
#include "tests/platform/window_user.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/need.hpp"
#include "tests/support/screen_picture.hpp"

using namespace bolt;
using namespace bolt::author;
using bolt::test::need;

namespace {

PreviewOptions options() {
    PreviewOptions o;
    o.source = "cover-m8";
    o.size = {160, 120};
    return o;
}

struct Preview {
    PreviewOptions given = options();
    PreviewSources sources{given};
    platform::Desktop desktop = need(platform::Desktop::open());
    platform::Window window = need(platform::Window::open(desktop, {"cover-m8", 160, 120}));
    std::optional<gpu::Instance> instance;

    Preview() {
        view::ModelLoadResult loaded = sources.read_model(view::DetailLevel::near, {});
        REQUIRE(loaded.ok());
        sources.set_shown(std::move(loaded.model), view::DetailLevel::near, {});
        sources.set_shown(need(sources.read_light()));
        gpu::InstanceOptions validated;
        validated.validation = true;
        const std::vector<const char*> extensions = need(desktop.vulkan_extensions());
        validated.extensions = extensions;
        instance.emplace(need(gpu::Instance::create(validated)));
    }
    Status show() { return show_preview(given, sources, window, *instance); }
};

// Tests the screen for the grey background in a corner and the paint of the model slightly below the middle.
bool cover_is_shown(std::uint32_t width, std::uint32_t height) {
    const auto screen = test::read_screen();
    if (!screen) return false;
    const auto corner = screen->at(width - 2, 2),
               paint = screen->at(width / 2 - height / 24, 13 * height / 20);
    return corner[0] > 100 && corner[0] < 200 && paint[0] < 70 && paint[2] > paint[0] + 10;
}

// Every device loads its functions again, so the loader has to return the failing function. A submission that
// waits on a semaphore is a frame of the window; uploads wait on none.
PFN_vkGetDeviceProcAddr real_loader = nullptr;
PFN_vkQueueSubmit2 real_submit = nullptr;
int window_frames_until_lost = 0;  // 0: no frame fails
bool every_submission_fails = false;

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos,
                                      VkFence fence) {
    const bool of_window = count == 1 && infos[0].waitSemaphoreInfoCount > 0;
    if (of_window && window_frames_until_lost > 0 && --window_frames_until_lost == 0)
        return VK_ERROR_DEVICE_LOST;
    return every_submission_fails ? VK_ERROR_DEVICE_LOST : real_submit(queue, count, infos, fence);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL loader(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = real_loader(device, name);
    if (std::strcmp(name, "vkQueueSubmit2") != 0) return real;
    real_submit = reinterpret_cast<PFN_vkQueueSubmit2>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(submit);
}

// During its lifetime, new devices get a queue that can fail.
struct FailingQueue {
    FailingQueue() { real_loader = std::exchange(vkGetDeviceProcAddr, loader); }
    ~FailingQueue() {
        vkGetDeviceProcAddr = real_loader;
        every_submission_fails = false;
        window_frames_until_lost = 0;
    }
    FailingQueue(const FailingQueue&) = delete;
    FailingQueue& operator=(const FailingQueue&) = delete;
};

}  // namespace

TEST_CASE("Preview: the window shows the model until the user closes it") {
    Preview preview;
    bool seen = false;
    std::thread user([&] {
        seen = test::eventually([] { return cover_is_shown(160, 120); });
        test::WindowUser("cover-m8").close();
    });
    const Status shown = preview.show();
    user.join();
    CHECK(seen);
    CHECK_MESSAGE(shown.has_value(), (shown ? "" : shown.error().message()));
}

TEST_CASE("Preview: a lost GPU is restarted, and the camera keeps its pose") {
    Preview preview;
    const FailingQueue failing;
    window_frames_until_lost = 2;
    bool seen = false, seen_large = false;
    std::thread user([&] {
        seen = test::eventually([] { return cover_is_shown(160, 120); });
        test::WindowUser hand("cover-m8");
        hand.key("F11");  // the second frame, which is lost
        seen_large = test::eventually([] { return cover_is_shown(1280, 800); });
        hand.key("Escape");
    });
    const Status shown = preview.show();
    user.join();
    CHECK(seen);
    CHECK(window_frames_until_lost == 0);
    CHECK(seen_large);
    CHECK_MESSAGE(shown.has_value(), (shown ? "" : shown.error().message()));
}

TEST_CASE("Preview: a GPU lost twice within 10 s ends the preview with no_device") {
    Preview preview;
    const FailingQueue failing;
    every_submission_fails = true;
    const Status shown = preview.show();
    REQUIRE_FALSE(shown.has_value());
    CHECK(shown.error().code == ErrorCode::no_device);
    CHECK(shown.error().what.find("lost twice within 10 s") != std::string::npos);
    CHECK(shown.error().what.find("VK_ERROR_DEVICE_LOST") != std::string::npos);
}

TEST_CASE("Preview: the device-loss policy allows a restart only after 10 s of work") {
    gpu::DeviceLossPolicy loss_policy;
    CHECK(loss_policy.should_restart(100.0));
    CHECK_FALSE(loss_policy.should_restart(109.9));
    CHECK(loss_policy.should_restart(119.9));
    CHECK_FALSE(loss_policy.should_restart(120.0));
}
