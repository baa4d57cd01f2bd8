// Chooses the swapchain's format, present mode, size and image count, with reasons. A pure function over the
// surface's capabilities, so that tests need no window.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// The capabilities of a surface, as Vulkan reports them.
struct SurfaceSupport {
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkSurfaceFormatKHR> formats;
    std::vector<VkPresentModeKHR> modes;
};

VkResult query_surface(VkPhysicalDevice gpu, VkSurfaceKHR surface, SurfaceSupport& offer);

struct SwapchainRequest {
    VkExtent2D window{};          // pixels; used if the surface leaves the size to us
    bool may_tear = false;        // for measurements: never wait for the screen
    std::uint32_t in_flight = 2;  // frames that are drawn while others are shown
};

struct SwapchainPlan {
    VkSurfaceFormatKHR format{};
    VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
    VkExtent2D extent{};  // a zero width or height: nothing can be shown now (minimised window)
    std::uint32_t images = 0;
    VkSurfaceTransformFlagBitsKHR transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    VkCompositeAlphaFlagBitsKHR alpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    std::vector<std::string> reasons;  // one line per decision
};

// Fails if the surface lacks something required, and names it.
Result<SwapchainPlan> plan_swapchain(const SurfaceSupport& offer, const SwapchainRequest& wish);

}  // namespace bolt::gpu
