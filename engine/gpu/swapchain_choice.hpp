// How pictures get to a surface, and why so: what the surface can, and a pure function over that, so that it
// can be tested without one.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// What a surface can, as Vulkan tells it.
struct SurfaceOffer {
    VkSurfaceCapabilitiesKHR capabilities{};
    std::vector<VkSurfaceFormatKHR> formats;
    std::vector<VkPresentModeKHR> modes;
};

// Asks for it.
VkResult ask_surface(VkPhysicalDevice gpu, VkSurfaceKHR surface, SurfaceOffer& offer);

struct SwapchainWish {
    VkExtent2D window{};          // pixels; used where the surface leaves the size to us
    bool may_tear = false;        // for measuring: never wait for the screen
    std::uint32_t in_flight = 2;  // frames that are drawn while others are shown
};

struct SwapchainPlan {
    VkSurfaceFormatKHR format{};
    VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
    VkExtent2D extent{};  // nothing in one direction: there is nothing to show on now (a minimised window)
    std::uint32_t images = 0;
    VkSurfaceTransformFlagBitsKHR transform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    VkCompositeAlphaFlagBitsKHR alpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    std::vector<std::string> reasons;  // a line a decision
};

// An error names what the surface lacks.
Result<SwapchainPlan> plan_swapchain(const SurfaceOffer& offer, const SwapchainWish& wish);

}  // namespace bolt::gpu
