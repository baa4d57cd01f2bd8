#include "engine/gpu/swapchain_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace bolt::gpu {

namespace {

constexpr std::uint32_t undefined_extent =
    0xFFFFFFFF;  // the value of VkSurfaceCapabilitiesKHR for "the swapchain decides"

const char* name(VkPresentModeKHR mode) {
    switch (mode) {
        case VK_PRESENT_MODE_IMMEDIATE_KHR:
            return "immediate";
        case VK_PRESENT_MODE_MAILBOX_KHR:
            return "mailbox";
        case VK_PRESENT_MODE_FIFO_KHR:
            return "fifo";
        case VK_PRESENT_MODE_FIFO_RELAXED_KHR:
            return "relaxed fifo";
        default:
            return "another mode";
    }
}

// Pictures are 8-bit sRGB. The first format needs no conversion, the second one swaps red and blue.
struct Known {
    VkFormat format;
    const char* text;
};
constexpr Known known[] = {
    {VK_FORMAT_R8G8B8A8_SRGB, "RGBA sRGB: no conversion"},
    {VK_FORMAT_B8G8R8A8_SRGB, "BGRA sRGB: converted by the copy"},
};

Status choose_format(const SurfaceSupport& offer, SwapchainPlan& plan) {
    for (const Known& wanted : known)
        for (const VkSurfaceFormatKHR& format : offer.formats)
            if (format.format == wanted.format && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                plan.format = format;
                plan.reasons.push_back(fmt::format("format {}", wanted.text));
                return {};
            }
    std::vector<int> offered;
    for (const VkSurfaceFormatKHR& format : offer.formats) offered.push_back(static_cast<int>(format.format));
    return fail(
        ErrorCode::no_device,
        fmt::format("the window supports no 8-bit sRGB format (VkFormat: {})", fmt::join(offered, ", ")),
        "VK_FORMAT_B8G8R8A8_SRGB or VK_FORMAT_R8G8B8A8_SRGB");
}

void choose_mode(const SurfaceSupport& offer, const SwapchainRequest& wish, SwapchainPlan& plan) {
    const auto offers = [&](VkPresentModeKHR mode) {
        return std::find(offer.modes.begin(), offer.modes.end(), mode) != offer.modes.end();
    };
    const auto take = [&](VkPresentModeKHR mode, const char* why) {
        plan.mode = mode;
        plan.reasons.push_back(fmt::format("{}: {}", name(mode), why));
    };
    if (wish.may_tear && offers(VK_PRESENT_MODE_IMMEDIATE_KHR))
        return take(VK_PRESENT_MODE_IMMEDIATE_KHR, "tearing is allowed");
    if (offers(VK_PRESENT_MODE_MAILBOX_KHR))
        return take(VK_PRESENT_MODE_MAILBOX_KHR, "the newest picture, without tearing or queueing");
    take(VK_PRESENT_MODE_FIFO_KHR, "mailbox is not available, fifo always is");
}

void choose_extent(const VkSurfaceCapabilitiesKHR& can, const SwapchainRequest& wish, SwapchainPlan& plan) {
    plan.extent = can.currentExtent;
    if (can.currentExtent.width == undefined_extent) {
        plan.extent = wish.window;
        if (plan.extent.width == 0 || plan.extent.height == 0) return;
        plan.extent = {std::clamp(wish.window.width, can.minImageExtent.width, can.maxImageExtent.width),
                       std::clamp(wish.window.height, can.minImageExtent.height, can.maxImageExtent.height)};
    }
}

}  // namespace

VkResult query_surface(VkPhysicalDevice gpu, VkSurfaceKHR surface, SurfaceSupport& offer) {
    VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu, surface, &offer.capabilities);
    if (result == VK_SUCCESS)
        result = enumerate(offer.formats, [&](std::uint32_t* count, VkSurfaceFormatKHR* formats) {
            return vkGetPhysicalDeviceSurfaceFormatsKHR(gpu, surface, count, formats);
        });
    if (result == VK_SUCCESS)
        result = enumerate(offer.modes, [&](std::uint32_t* count, VkPresentModeKHR* modes) {
            return vkGetPhysicalDeviceSurfacePresentModesKHR(gpu, surface, count, modes);
        });
    return result;
}

Result<SwapchainPlan> plan_swapchain(const SurfaceSupport& offer, const SwapchainRequest& wish) {
    SwapchainPlan plan;
    const VkSurfaceCapabilitiesKHR& can = offer.capabilities;
    if ((can.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0)
        return fail(ErrorCode::no_device, "the window's images do not support copies");
    BOLT_TRY(choose_format(offer, plan));
    choose_mode(offer, wish, plan);
    choose_extent(can, wish, plan);

    // One image is on the screen; in mailbox mode another one waits.
    const std::uint32_t shown = plan.mode == VK_PRESENT_MODE_MAILBOX_KHR ? 2 : 1;
    plan.images = std::max(can.minImageCount, wish.in_flight + shown - 1);
    if (plan.mode == VK_PRESENT_MODE_MAILBOX_KHR) plan.images = std::max(plan.images, can.minImageCount + 1);
    if (can.maxImageCount != 0) plan.images = std::min(plan.images, can.maxImageCount);
    plan.reasons.push_back(fmt::format("{} images, the minimum is {}", plan.images, can.minImageCount));

    plan.transform = can.currentTransform;
    if ((can.supportedTransforms & VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR) != 0)
        plan.transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    // Windows are opaque. If the surface does not offer opaque composition, the alpha values are 1 anyway.
    for (const VkCompositeAlphaFlagBitsKHR alpha :
         {VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR, VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
          VK_COMPOSITE_ALPHA_PRE_MULTIPLIED_BIT_KHR, VK_COMPOSITE_ALPHA_POST_MULTIPLIED_BIT_KHR})
        if ((can.supportedCompositeAlpha & static_cast<VkFlags>(alpha)) != 0) {
            plan.alpha = alpha;
            break;
        }
    return plan;
}

}  // namespace bolt::gpu
