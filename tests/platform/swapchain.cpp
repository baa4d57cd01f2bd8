// Presentation, also after changes of the window and after loss of surface or device.
#include "engine/gpu/swapchain.hpp"

#include <map>
#include <set>

#include "engine/gpu/resources.hpp"
#include "tests/platform/fault.hpp"
#include "tests/platform/show_case.hpp"
#include "tests/support/eventually.hpp"

using namespace bolt;

namespace {

using Color = std::array<int, 3>;
constexpr Color red{200, 30, 10}, green{20, 180, 40}, blue{0, 60, 250};

// The X server draws asynchronously, so wait for the result.
bool screen_shows(const Color& color, std::uint32_t x, std::uint32_t y) {
    return test::eventually([&] { return test::need(test::read_screen()).at(x, y) == color; });
}

bool fills_window(const Color& color, std::uint32_t width, std::uint32_t height) {
    return screen_shows(color, 0, 0) && screen_shows(color, width - 1, height - 1);
}

}  // namespace

TEST_CASE("Swapchain: a picture fills the window with exact values, frame after frame") {
    test::ShowCase show("plain");
    for (int round = 0; round < 3; ++round)
        for (const Color& color : {red, green, blue}) {
            show.show_surely(color);
            CHECK(fills_window(color, 320, 240));
        }
    for (int i = 0; i < 40; ++i) show.show_surely({i, 6 * i, 255 - i});
    CHECK(fills_window({39, 234, 216}, 320, 240));
    CHECK(show.swapchain().creations() == 1);
    CHECK(show.swapchain().plan().reasons.size() == 3);
    CHECK(screen_shows({0, 0, 0}, 400, 300));  // the screen beside the window is black
}

namespace {

// Records the swapchain's Vulkan calls. The test drivers do not detect a semaphore that is used too
// early, so the tests check the recorded calls.
struct Record {
    std::vector<VkSemaphore> acquired;                // in order
    std::map<std::uint32_t, VkSemaphore> shown_with;  // by image
    bool each_image_its_own = true, waits_where_barriers_begin = true;
    PFN_vkAcquireNextImageKHR acquire = vkAcquireNextImageKHR;
    PFN_vkQueueSubmit2 submit = vkQueueSubmit2;
    PFN_vkQueuePresentKHR present = vkQueuePresentKHR;
};
Record* record = nullptr;

VKAPI_ATTR VkResult VKAPI_CALL recorded_acquire(VkDevice device, VkSwapchainKHR swapchain,
                                                std::uint64_t timeout, VkSemaphore semaphore, VkFence fence,
                                                std::uint32_t* index) {
    record->acquired.push_back(semaphore);
    if (record->acquired.size() == 12) {  // withhold one image, so that others are used
        const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
        VkFence here = VK_NULL_HANDLE;
        vkCreateFence(device, &info, nullptr, &here);
        record->acquire(device, swapchain, timeout, VK_NULL_HANDLE, here, index);
        vkWaitForFences(device, 1, &here, VK_TRUE, timeout);
        vkDestroyFence(device, here, nullptr);
    }
    return record->acquire(device, swapchain, timeout, semaphore, fence, index);
}
VKAPI_ATTR VkResult VKAPI_CALL recorded_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos,
                                               VkFence fence) {
    if (infos[0].waitSemaphoreInfoCount > 0)
        record->waits_where_barriers_begin &=
            infos[0].pWaitSemaphoreInfos[0].stageMask == gpu::use_info(gpu::ResourceUse::acquired).stages;
    return record->submit(queue, count, infos, fence);
}
VKAPI_ATTR VkResult VKAPI_CALL recorded_present(VkQueue queue, const VkPresentInfoKHR* info) {
    const auto known = record->shown_with.try_emplace(*info->pImageIndices, *info->pWaitSemaphores).first;
    record->each_image_its_own &= known->second == *info->pWaitSemaphores;
    return record->present(queue, info);
}

}  // namespace

TEST_CASE("Swapchain: each frame in flight has one acquire semaphore, and each image one present semaphore") {
    test::ShowCase show("semaphores");
    show.show_surely(red);
    Record written;
    record = &written;
    vkAcquireNextImageKHR = recorded_acquire;
    vkQueueSubmit2 = recorded_submit;
    vkQueuePresentKHR = recorded_present;
    for (int i = 0; i < 24; ++i) show.show_surely(i % 2 == 0 ? green : blue);
    vkAcquireNextImageKHR = written.acquire;
    vkQueueSubmit2 = written.submit;
    vkQueuePresentKHR = written.present;
    REQUIRE(written.acquired.size() >= 24);
    for (std::size_t i = 1; i < written.acquired.size(); ++i)
        CHECK(written.acquired[i] != written.acquired[i - 1]);
    CHECK(written.shown_with.size() > 1);
    CHECK(written.each_image_its_own);
    std::set<VkSemaphore> different;
    for (const auto& [image, semaphore] : written.shown_with) different.insert(semaphore);
    CHECK(different.size() == written.shown_with.size());
    CHECK(written.waits_where_barriers_begin);
}

TEST_CASE("Swapchain: pictures of another size are scaled to the window") {
    test::ShowCase show("stretched");
    show.picture_size = VkExtent2D{50, 70};
    show.show_surely(green);
    CHECK(fills_window(green, 320, 240));
}

TEST_CASE("Swapchain: new sizes, larger, smaller and back, are presented") {
    test::ShowCase show("sizes");
    show.show_surely(red);
    for (const auto& size : {std::pair{500U, 400U}, {100U, 90U}, {320U, 240U}}) {
        const auto& width = size.first;
        const auto& height = size.second;
        show.window().resize({width, height});
        CHECK(test::eventually([&] {
            (void)test::need(show.show(blue));
            return show.drawn.width == width && show.drawn.height == height;
        }));
        show.show_surely(green);
        CHECK(fills_window(green, width, height));
    }
    CHECK(show.swapchain().creations() >= 4);
}

TEST_CASE("Swapchain: out-of-date images drop one picture and are recreated") {
    test::ShowCase show("out of date");
    show.show_surely(red);
    {
        const test::Fault<&vkAcquireNextImageKHR> fault(VK_ERROR_OUT_OF_DATE_KHR);
        CHECK_FALSE(test::need(show.show(green)));
        CHECK(fault.failed() == 1);
        CHECK(test::need(show.show(green)));
    }
    CHECK(show.swapchain().creations() == 2);
    CHECK(fills_window(green, 320, 240));
    {
        const test::Fault<&vkQueuePresentKHR> fault(VK_ERROR_OUT_OF_DATE_KHR, 1, test::Happens::afterwards);
        CHECK_FALSE(test::need(show.show(blue)));
        CHECK(test::need(show.show(blue)));
    }
    CHECK(show.swapchain().creations() == 3);
    CHECK(fills_window(blue, 320, 240));
    // While acquiring times out, pictures are dropped, and the swapchain is kept.
    {
        const test::Fault<&vkAcquireNextImageKHR> fault(VK_TIMEOUT, 3);
        for (int i = 0; i < 3; ++i) CHECK_FALSE(test::need(show.show(red)));
        CHECK(test::need(show.show(red)));
    }
    CHECK(show.swapchain().creations() == 3);
}

TEST_CASE(
    "Swapchain: suboptimal images are presented, and a swapchain that stays suboptimal is recreated only "
    "once") {
    test::ShowCase show("suboptimal");
    show.show_surely(red);
    const test::Fault<&vkQueuePresentKHR> fault(VK_SUBOPTIMAL_KHR, 1000, test::Happens::afterwards);
    for (int i = 0; i < 10; ++i) CHECK(test::need(show.show(green)));
    CHECK(fault.failed() == 10);
    CHECK(show.swapchain().creations() == 2);
    CHECK(fills_window(green, 320, 240));
}

TEST_CASE("Swapchain: a lost surface is replaced, wherever the loss is detected") {
    test::ShowCase show("lost surface");
    show.show_surely(red);
    {
        const test::Fault<&vkAcquireNextImageKHR> fault(VK_ERROR_SURFACE_LOST_KHR);
        CHECK_FALSE(test::need(show.show(green)));
        CHECK(test::need(show.show(green)));
    }
    CHECK(fills_window(green, 320, 240));
    {
        const test::Fault<&vkQueuePresentKHR> fault(VK_ERROR_SURFACE_LOST_KHR, 1, test::Happens::afterwards);
        CHECK_FALSE(test::need(show.show(blue)));
        CHECK(test::need(show.show(blue)));
    }
    CHECK(fills_window(blue, 320, 240));
    show.window().resize({200, 150});
    {
        const test::Fault<&vkGetPhysicalDeviceSurfaceCapabilitiesKHR> fault(VK_ERROR_SURFACE_LOST_KHR);
        CHECK(test::eventually([&] {
            (void)test::need(show.show(red));
            return show.drawn.width == 200;
        }));
        CHECK(fault.failed() == 1);
    }
    show.show_surely(red);
    CHECK(fills_window(red, 200, 150));
    {
        const test::Fault<&vkAcquireNextImageKHR> again(VK_ERROR_OUT_OF_DATE_KHR);
        const test::Fault<&vkCreateSwapchainKHR> fault(VK_ERROR_SURFACE_LOST_KHR);
        show.show_surely(green);
        CHECK(fault.failed() == 1);
    }
    CHECK(fills_window(green, 200, 150));
}

TEST_CASE("Swapchain: a surface that is lost repeatedly is an error but not a lost device") {
    test::ShowCase show("lost for good");
    const test::Fault<&vkAcquireNextImageKHR> fault(VK_ERROR_SURFACE_LOST_KHR, 1000);
    Result<bool> shown = true;
    for (int i = 0; i < 10 && shown; ++i) shown = show.show(red);
    REQUIRE_FALSE(shown.has_value());
    CHECK(fault.failed() == 3);
    CHECK(shown.error().code == ErrorCode::no_device);
    CHECK_FALSE(shown.error().lost);
    CHECK(shown.error().what.find("VK_ERROR_SURFACE_LOST_KHR") != std::string::npos);
}

namespace {

PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR real_capabilities = nullptr;
VKAPI_ATTR VkResult VKAPI_CALL minimised(VkPhysicalDevice gpu, VkSurfaceKHR surface,
                                         VkSurfaceCapabilitiesKHR* capabilities) {
    const VkResult result = real_capabilities(gpu, surface, capabilities);
    capabilities->currentExtent = capabilities->minImageExtent = capabilities->maxImageExtent = {0, 0};
    return result;
}

}  // namespace

TEST_CASE("Swapchain: a window with zero area is presented to only after it has an area again") {
    test::ShowCase show("minimised");
    show.show_surely(red);
    real_capabilities = std::exchange(vkGetPhysicalDeviceSurfaceCapabilitiesKHR, minimised);
    {
        const test::Fault<&vkAcquireNextImageKHR> fault(VK_ERROR_OUT_OF_DATE_KHR);
        CHECK_FALSE(test::need(show.show(green)));
    }
    for (int i = 0; i < 5; ++i) {
        CHECK_FALSE(test::need(show.show(green)));
        CHECK(show.drawn.width == 0);
    }
    vkGetPhysicalDeviceSurfaceCapabilitiesKHR = real_capabilities;
    CHECK(test::need(show.show(blue)));
    CHECK(fills_window(blue, 320, 240));
}

TEST_CASE("Swapchain: a lost device is reported, and recreated objects present in the same window") {
    test::ShowCase show("lost device");
    show.show_surely(red);
    const auto lost = [&](const Result<bool>& shown) {
        return !shown && shown.error().lost && shown.error().code == ErrorCode::no_device;
    };
    {
        const test::Fault<&vkQueueSubmit2> fault(VK_ERROR_DEVICE_LOST);
        CHECK(lost(show.show(green)));
        show.make_gpu();
    }
    show.show_surely(green);
    CHECK(fills_window(green, 320, 240));
    {
        const test::Fault<&vkQueuePresentKHR> fault(VK_ERROR_DEVICE_LOST, 1, test::Happens::afterwards);
        CHECK(lost(show.show(blue)));
        show.make_gpu();
    }
    show.show_surely(blue);
    {
        const test::Fault<&vkAcquireNextImageKHR> fault(VK_ERROR_DEVICE_LOST);
        CHECK(lost(show.show(red)));
        show.make_gpu();
    }
    {
        const test::Fault<&vkWaitForFences> fault(VK_ERROR_DEVICE_LOST);
        CHECK(lost(show.show(red)));
        show.make_gpu();
    }
    show.show_surely(red);
    CHECK(fills_window(red, 320, 240));
}
