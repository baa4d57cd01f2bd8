// The mock's swapchains, and reading their images back.
#include <algorithm>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock_openxr {

namespace {

constexpr std::uint32_t image_count = 3;

bool is_depth(VkFormat format) { return format == VK_FORMAT_D32_SFLOAT; }
VkImageAspectFlags aspect(VkFormat format) {
    return is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}
// The layout in which images come and must be returned (XR_KHR_vulkan_enable).
VkImageLayout layout(VkFormat format) {
    return is_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                            : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}
std::uint32_t texel_size(VkFormat format) { return format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8 : 4; }

std::uint32_t memory_type(const Vulkan& vk, std::uint32_t allowed, VkMemoryPropertyFlags wanted) {
    VkPhysicalDeviceMemoryProperties all{};
    vk.of_instance<PFN_vkGetPhysicalDeviceMemoryProperties>("vkGetPhysicalDeviceMemoryProperties")(vk.gpu,
                                                                                                   &all);
    for (std::uint32_t i = 0; i < all.memoryTypeCount; ++i)
        if ((allowed & (1U << i)) != 0 && (all.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    return 0;
}

// Records commands and waits for the GPU. The client's queue is used, as a runtime in the same process does.
template <class Record>
void run_commands(const Vulkan& vk, const Record& record) {
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.queueFamilyIndex = vk.family;
    VkCommandPool pool = VK_NULL_HANDLE;
    vk.of_device<PFN_vkCreateCommandPool>("vkCreateCommandPool")(vk.device, &pool_info, nullptr, &pool);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vk.of_device<PFN_vkAllocateCommandBuffers>("vkAllocateCommandBuffers")(vk.device, &allocate, &commands);
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vk.of_device<PFN_vkBeginCommandBuffer>("vkBeginCommandBuffer")(commands, &begin);
    record(commands);
    vk.of_device<PFN_vkEndCommandBuffer>("vkEndCommandBuffer")(commands);
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    vk.of_device<PFN_vkQueueSubmit>("vkQueueSubmit")(vk.queue, 1, &submit, VK_NULL_HANDLE);
    vk.of_device<PFN_vkQueueWaitIdle>("vkQueueWaitIdle")(vk.queue);
    vk.of_device<PFN_vkDestroyCommandPool>("vkDestroyCommandPool")(vk.device, pool, nullptr);
}

void barrier(const Vulkan& vk, VkCommandBuffer commands, VkImage image, VkFormat format, VkImageLayout from,
             VkImageLayout to) {
    VkImageMemoryBarrier change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    change.srcAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    change.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange = {aspect(format), 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
    vk.of_device<PFN_vkCmdPipelineBarrier>("vkCmdPipelineBarrier")(
        commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
        nullptr, 1, &change);
}

VkImage make_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, VkDeviceMemory& memory) {
    const auto format = static_cast<VkFormat>(info.format);
    VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = format;
    create.extent = {info.width, info.height, 1};
    create.mipLevels = 1;
    create.arrayLayers = info.arraySize;
    create.samples = VK_SAMPLE_COUNT_1_BIT;
    create.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    if ((info.usageFlags & XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT) != 0)
        create.usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if ((info.usageFlags & XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0)
        create.usage |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if ((info.usageFlags & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) != 0)
        create.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;
    vk.of_device<PFN_vkCreateImage>("vkCreateImage")(vk.device, &create, nullptr, &image);
    VkMemoryRequirements needs{};
    vk.of_device<PFN_vkGetImageMemoryRequirements>("vkGetImageMemoryRequirements")(vk.device, image, &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = memory_type(vk, needs.memoryTypeBits, 0);
    vk.of_device<PFN_vkAllocateMemory>("vkAllocateMemory")(vk.device, &allocate, nullptr, &memory);
    vk.of_device<PFN_vkBindImageMemory>("vkBindImageMemory")(vk.device, image, memory, 0);
    run_commands(vk, [&](VkCommandBuffer commands) {
        barrier(vk, commands, image, format, VK_IMAGE_LAYOUT_UNDEFINED, layout(format));
    });
    return image;
}

XrResult formats(XrSession, std::uint32_t capacity, std::uint32_t* count, std::int64_t* values) {
    MOCK_ENTER("xrEnumerateSwapchainFormats");
    *count = static_cast<std::uint32_t>(s.config.formats.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    std::copy(s.config.formats.begin(), s.config.formats.end(), values);
    return XR_SUCCESS;
}

XrResult create_swapchain(XrSession, const XrSwapchainCreateInfo* info, XrSwapchain* swapchain) {
    MOCK_ENTER("xrCreateSwapchain");
    if (std::find(s.config.formats.begin(), s.config.formats.end(), info->format) == s.config.formats.end())
        return XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED;
    if (s.config.refuses_arrays && info->arraySize > 1) return XR_ERROR_FEATURE_UNSUPPORTED;
    if (info->width > 2 * s.config.width || info->height > 2 * s.config.height)
        s.violation("a swapchain larger than the largest image");
    auto made = std::make_unique<Swapchain>();
    made->width = info->width;
    made->height = info->height;
    made->layers = info->arraySize;
    made->format = static_cast<VkFormat>(info->format);
    for (std::uint32_t i = 0; i < image_count; ++i) {
        VkDeviceMemory memory = VK_NULL_HANDLE;
        made->images.push_back(make_image(s.vulkan, *info, memory));
        made->memory.push_back(memory);
    }
    *swapchain = reinterpret_cast<XrSwapchain>(made.get());
    s.swapchains.insert(std::move(made));
    return XR_SUCCESS;
}

XrResult destroy_swapchain(XrSwapchain handle) {
    MOCK_ENTER("xrDestroySwapchain");
    Swapchain* swapchain = find(s.swapchains, handle);
    if (swapchain == nullptr) {
        s.violation("xrDestroySwapchain of an unknown swapchain");
        return XR_ERROR_HANDLE_INVALID;
    }
    destroy_images(s.vulkan, *swapchain);
    erase(s.swapchains, handle);
    return XR_SUCCESS;
}

XrResult list_images(XrSwapchain handle, std::uint32_t capacity, std::uint32_t* count,
                     XrSwapchainImageBaseHeader* values) {
    MOCK_ENTER("xrEnumerateSwapchainImages");
    const Swapchain* swapchain = find(s.swapchains, handle);
    if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
    *count = image_count;
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < image_count) return XR_ERROR_SIZE_INSUFFICIENT;
    auto* images = reinterpret_cast<XrSwapchainImageVulkan2KHR*>(values);
    for (std::uint32_t i = 0; i < image_count; ++i) images[i].image = swapchain->images[i];
    return XR_SUCCESS;
}

XrResult acquire(XrSwapchain handle, const XrSwapchainImageAcquireInfo*, std::uint32_t* index) {
    MOCK_ENTER("xrAcquireSwapchainImage");
    Swapchain* swapchain = find(s.swapchains, handle);
    if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (swapchain->acquired.size() >= image_count - 1) {
        s.violation("too many images are acquired");
        return XR_ERROR_CALL_ORDER_INVALID;
    }
    *index = swapchain->next;
    swapchain->acquired.push_back(swapchain->next);
    swapchain->next = (swapchain->next + 1) % image_count;
    return XR_SUCCESS;
}

XrResult wait_image(XrSwapchain handle, const XrSwapchainImageWaitInfo*) {
    MOCK_ENTER("xrWaitSwapchainImage");
    Swapchain* swapchain = find(s.swapchains, handle);
    if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (swapchain->acquired.empty() || swapchain->waited) {
        s.violation("xrWaitSwapchainImage without an acquired image");
        return XR_ERROR_CALL_ORDER_INVALID;
    }
    swapchain->waited = true;
    return XR_SUCCESS;
}

XrResult release(XrSwapchain handle, const XrSwapchainImageReleaseInfo*) {
    MOCK_ENTER("xrReleaseSwapchainImage");
    Swapchain* swapchain = find(s.swapchains, handle);
    if (swapchain == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (!swapchain->waited) {
        s.violation("xrReleaseSwapchainImage without xrWaitSwapchainImage");
        return XR_ERROR_CALL_ORDER_INVALID;
    }
    swapchain->released = swapchain->acquired.front();
    swapchain->acquired.pop_front();
    swapchain->waited = false;
    return XR_SUCCESS;
}

}  // namespace

void destroy_images(const Vulkan& vk, Swapchain& swapchain) {
    vk.of_device<PFN_vkQueueWaitIdle>("vkQueueWaitIdle")(vk.queue);
    for (const VkImage image : swapchain.images)
        vk.of_device<PFN_vkDestroyImage>("vkDestroyImage")(vk.device, image, nullptr);
    for (const VkDeviceMemory memory : swapchain.memory)
        vk.of_device<PFN_vkFreeMemory>("vkFreeMemory")(vk.device, memory, nullptr);
    swapchain.images.clear();
    swapchain.memory.clear();
}

std::vector<std::uint8_t> read_image(const Vulkan& vk, const Swapchain& swapchain, std::uint32_t layer,
                                     std::uint32_t width, std::uint32_t height) {
    const VkImage image = swapchain.images[*swapchain.released];
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = VkDeviceSize{texel_size(swapchain.format)} * width * height;
    create.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    VkBuffer buffer = VK_NULL_HANDLE;
    vk.of_device<PFN_vkCreateBuffer>("vkCreateBuffer")(vk.device, &create, nullptr, &buffer);
    VkMemoryRequirements needs{};
    vk.of_device<PFN_vkGetBufferMemoryRequirements>("vkGetBufferMemoryRequirements")(vk.device, buffer,
                                                                                     &needs);
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = memory_type(
        vk, needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    vk.of_device<PFN_vkAllocateMemory>("vkAllocateMemory")(vk.device, &allocate, nullptr, &memory);
    vk.of_device<PFN_vkBindBufferMemory>("vkBindBufferMemory")(vk.device, buffer, memory, 0);
    run_commands(vk, [&](VkCommandBuffer commands) {
        const VkImageLayout at_rest = layout(swapchain.format);
        barrier(vk, commands, image, swapchain.format, at_rest, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VkBufferImageCopy region{};
        region.imageSubresource = {aspect(swapchain.format), 0, layer, 1};
        region.imageExtent = {width, height, 1};
        vk.of_device<PFN_vkCmdCopyImageToBuffer>("vkCmdCopyImageToBuffer")(
            commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
        barrier(vk, commands, image, swapchain.format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, at_rest);
    });
    void* mapped = nullptr;
    vk.of_device<PFN_vkMapMemory>("vkMapMemory")(vk.device, memory, 0, create.size, 0, &mapped);
    const auto* first = static_cast<const std::uint8_t*>(mapped);
    std::vector<std::uint8_t> bytes(first, first + create.size);
    vk.of_device<PFN_vkDestroyBuffer>("vkDestroyBuffer")(vk.device, buffer, nullptr);
    vk.of_device<PFN_vkFreeMemory>("vkFreeMemory")(vk.device, memory, nullptr);
    return bytes;
}

void add_image_functions(Functions& f) {
    f.insert({{"xrEnumerateSwapchainFormats", as_void(formats)},
              {"xrCreateSwapchain", as_void(create_swapchain)},
              {"xrDestroySwapchain", as_void(destroy_swapchain)},
              {"xrEnumerateSwapchainImages", as_void(list_images)},
              {"xrAcquireSwapchainImage", as_void(acquire)},
              {"xrWaitSwapchainImage", as_void(wait_image)},
              {"xrReleaseSwapchainImage", as_void(release)}});
}

}  // namespace bolt::mock_openxr
