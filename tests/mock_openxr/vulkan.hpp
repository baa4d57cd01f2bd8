// Vulkan for the mock runtime, through the functions that the client hands over. It makes the images of the
// swapchains and reads them back.
#pragma once

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>
// The order matters: openxr_platform.h needs Vulkan's types.
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr_platform.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/mock_openxr/mock_openxr.hpp"

namespace bolt::mock {

// The Vulkan objects that the runtime made for the client.
struct VulkanObjects {
    PFN_vkGetInstanceProcAddr get_proc = nullptr;
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
};

VkResult create_instance(VulkanObjects& objects, PFN_vkGetInstanceProcAddr get_proc,
                         const VkInstanceCreateInfo& info, const VkAllocationCallbacks* allocator);
VkResult find_physical_device(VulkanObjects& objects);
VkResult create_device(VulkanObjects& objects, const VkDeviceCreateInfo& info,
                       const VkAllocationCallbacks* allocator);

struct SwapchainImage {
    VkImage image = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    bool prepared = false;  // in the layout in which the client gets it
};

// The functions of the session's device, and its queue.
struct Vulkan {
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memory{};
#define BOLT_MOCK_DEVICE_FUNCTIONS(each)                                                                   \
    each(GetDeviceQueue) each(CreateImage) each(DestroyImage) each(GetImageMemoryRequirements)             \
        each(AllocateMemory) each(FreeMemory) each(BindImageMemory) each(CreateBuffer) each(DestroyBuffer) \
            each(GetBufferMemoryRequirements) each(BindBufferMemory) each(MapMemory) each(UnmapMemory)     \
                each(CreateCommandPool) each(DestroyCommandPool) each(AllocateCommandBuffers)              \
                    each(FreeCommandBuffers) each(BeginCommandBuffer) each(EndCommandBuffer)               \
                        each(CmdPipelineBarrier) each(CmdCopyImageToBuffer) each(QueueSubmit)              \
                            each(CreateFence) each(DestroyFence) each(WaitForFences)
#define BOLT_MOCK_MEMBER(name) PFN_vk##name name = nullptr;
    BOLT_MOCK_DEVICE_FUNCTIONS(BOLT_MOCK_MEMBER)
#undef BOLT_MOCK_MEMBER
};

VkResult open_device(Vulkan& vk, const VulkanObjects& objects, std::uint32_t family, std::uint32_t index);
void close_device(Vulkan& vk);

bool is_depth(VkFormat format);
VkResult create_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, SwapchainImage& image);
void destroy_image(const Vulkan& vk, const SwapchainImage& image);
// Brings a new image to the layout in which the client gets it.
VkResult prepare_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, SwapchainImage& image);

// Reads the rectangle of one layer, in the format of the swapchain, and restores the layout.
VkResult read_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, VkImage image, std::uint32_t layer,
                    const XrRect2Di& rect, std::vector<std::uint8_t>& bytes);
// Converts texels of the swapchain's format to 8-bit RGBA with sRGB's encoding; empty: unknown format.
std::vector<std::uint8_t> to_rgba8(VkFormat format, const std::vector<std::uint8_t>& bytes);

}  // namespace bolt::mock
