#include "tests/mock_openxr/vulkan.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

namespace bolt::mock {

namespace {

template <class Function>
Function load(PFN_vkGetInstanceProcAddr get_proc, VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(get_proc(instance, name));
}

// Returns the names that the client enabled, with `wanted` if it is available and the client lacks it.
std::vector<const char*> with_extension(const char* const* names, std::uint32_t count, const char* wanted,
                                        const std::vector<VkExtensionProperties>& available) {
    std::vector<const char*> all(names, names + count);
    const auto same = [&](const char* name) { return std::strcmp(name, wanted) == 0; };
    const bool offered =
        std::any_of(available.begin(), available.end(),
                    [&](const VkExtensionProperties& extension) { return same(extension.extensionName); });
    if (offered && std::none_of(all.begin(), all.end(), same)) all.push_back(wanted);
    return all;
}

constexpr std::uint32_t texel_size(VkFormat format) {
    return format == VK_FORMAT_R16G16B16A16_SFLOAT || format == VK_FORMAT_R16G16B16A16_UNORM ? 8 : 4;
}

std::uint32_t memory_type(const Vulkan& vk, std::uint32_t allowed, VkMemoryPropertyFlags flags) {
    for (std::uint32_t i = 0; i < vk.memory.memoryTypeCount; ++i)
        if ((allowed & (1U << i)) != 0 && (vk.memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
    return 0;
}

VkResult allocate(const Vulkan& vk, const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                  VkDeviceMemory& memory) {
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = memory_type(vk, needs.memoryTypeBits, flags);
    return vk.AllocateMemory(vk.device, &info, nullptr, &memory);
}

// Records commands, submits them and waits for their completion.
VkResult run(const Vulkan& vk, const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = vk.pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    if (const VkResult result = vk.AllocateCommandBuffers(vk.device, &allocation, &commands)) return result;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkFenceCreateInfo fence_info{};
    fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    VkFence fence = VK_NULL_HANDLE;
    VkResult result = vk.BeginCommandBuffer(commands, &begin);
    if (result == VK_SUCCESS) {
        record(commands);
        result = vk.EndCommandBuffer(commands);
    }
    if (result == VK_SUCCESS) result = vk.CreateFence(vk.device, &fence_info, nullptr, &fence);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    if (result == VK_SUCCESS) result = vk.QueueSubmit(vk.queue, 1, &submit, fence);
    if (result == VK_SUCCESS) result = vk.WaitForFences(vk.device, 1, &fence, VK_TRUE, UINT64_MAX);
    if (fence != VK_NULL_HANDLE) vk.DestroyFence(vk.device, fence, nullptr);
    vk.FreeCommandBuffers(vk.device, vk.pool, 1, &commands);
    return result;
}

void barrier(const Vulkan& vk, VkCommandBuffer commands, VkImage image, const XrSwapchainCreateInfo& info,
             VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier change{};
    change.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    change.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    change.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    change.oldLayout = from;
    change.newLayout = to;
    change.srcQueueFamilyIndex = change.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    change.image = image;
    change.subresourceRange.aspectMask =
        is_depth(static_cast<VkFormat>(info.format)) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    change.subresourceRange.levelCount = 1;
    change.subresourceRange.layerCount = info.arraySize;
    vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                          0, nullptr, 0, nullptr, 1, &change);
}

VkImageLayout client_layout(const XrSwapchainCreateInfo& info) {
    return is_depth(static_cast<VkFormat>(info.format)) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                                        : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

// A buffer that the CPU reads.
struct ReadBuffer {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
};

VkResult create_buffer(const Vulkan& vk, VkDeviceSize size, ReadBuffer& out) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (const VkResult result = vk.CreateBuffer(vk.device, &info, nullptr, &out.buffer)) return result;
    VkMemoryRequirements needs{};
    vk.GetBufferMemoryRequirements(vk.device, out.buffer, &needs);
    constexpr VkMemoryPropertyFlags host =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (const VkResult result = allocate(vk, needs, host, out.memory)) return result;
    return vk.BindBufferMemory(vk.device, out.buffer, out.memory, 0);
}

float half_to_float(std::uint16_t half) {
    const int exponent = (half >> 10U) & 31;
    const auto mantissa = static_cast<float>(half & 1023U);
    const float magnitude =
        exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024.0F + mantissa, exponent - 25);
    return (half & 0x8000U) != 0 ? -magnitude : magnitude;
}

std::uint8_t encode_srgb(float linear) {
    const float x = std::clamp(linear, 0.0F, 1.0F);
    const float encoded = x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(255.0F * encoded));
}

}  // namespace

bool is_depth(VkFormat format) { return format == VK_FORMAT_D32_SFLOAT; }

VkResult create_instance(VulkanObjects& objects, PFN_vkGetInstanceProcAddr get_proc,
                         const VkInstanceCreateInfo& info, const VkAllocationCallbacks* allocator) {
    objects.get_proc = get_proc;
    const auto enumerate = load<PFN_vkEnumerateInstanceExtensionProperties>(
        get_proc, VK_NULL_HANDLE, "vkEnumerateInstanceExtensionProperties");
    std::uint32_t count = 0;
    (void)enumerate(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> available(count);
    (void)enumerate(nullptr, &count, available.data());
    const std::vector<const char*> names =
        with_extension(info.ppEnabledExtensionNames, info.enabledExtensionCount,
                       VK_KHR_EXTERNAL_MEMORY_CAPABILITIES_EXTENSION_NAME, available);
    VkInstanceCreateInfo extended = info;
    extended.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
    extended.ppEnabledExtensionNames = names.data();
    return load<PFN_vkCreateInstance>(get_proc, VK_NULL_HANDLE, "vkCreateInstance")(&extended, allocator,
                                                                                    &objects.instance);
}

VkResult find_physical_device(VulkanObjects& objects) {
    std::uint32_t count = 1;
    const VkResult result = load<PFN_vkEnumeratePhysicalDevices>(
        objects.get_proc, objects.instance, "vkEnumeratePhysicalDevices")(objects.instance, &count,
                                                                          &objects.physical);
    return result == VK_INCOMPLETE ? VK_SUCCESS : result;
}

VkResult create_device(VulkanObjects& objects, const VkDeviceCreateInfo& info,
                       const VkAllocationCallbacks* allocator) {
    const auto enumerate = load<PFN_vkEnumerateDeviceExtensionProperties>(
        objects.get_proc, objects.instance, "vkEnumerateDeviceExtensionProperties");
    std::uint32_t count = 0;
    (void)enumerate(objects.physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> available(count);
    (void)enumerate(objects.physical, nullptr, &count, available.data());
    const std::vector<const char*> names =
        with_extension(info.ppEnabledExtensionNames, info.enabledExtensionCount,
                       VK_KHR_EXTERNAL_MEMORY_EXTENSION_NAME, available);
    VkDeviceCreateInfo extended = info;
    extended.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
    extended.ppEnabledExtensionNames = names.data();
    return load<PFN_vkCreateDevice>(objects.get_proc, objects.instance, "vkCreateDevice")(
        objects.physical, &extended, allocator, &objects.device);
}

VkResult open_device(Vulkan& vk, const VulkanObjects& objects, std::uint32_t family, std::uint32_t index) {
    vk.device = objects.device;
    const auto get = load<PFN_vkGetDeviceProcAddr>(objects.get_proc, objects.instance, "vkGetDeviceProcAddr");
#define BOLT_MOCK_LOAD(name) vk.name = reinterpret_cast<PFN_vk##name>(get(objects.device, "vk" #name));
    BOLT_MOCK_DEVICE_FUNCTIONS(BOLT_MOCK_LOAD)
#undef BOLT_MOCK_LOAD
    load<PFN_vkGetPhysicalDeviceMemoryProperties>(objects.get_proc, objects.instance,
                                                  "vkGetPhysicalDeviceMemoryProperties")(objects.physical,
                                                                                         &vk.memory);
    vk.GetDeviceQueue(vk.device, family, index, &vk.queue);
    VkCommandPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    info.queueFamilyIndex = family;
    return vk.CreateCommandPool(vk.device, &info, nullptr, &vk.pool);
}

void close_device(Vulkan& vk) {
    if (vk.pool != VK_NULL_HANDLE) vk.DestroyCommandPool(vk.device, vk.pool, nullptr);
    vk = {};
}

VkResult create_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, SwapchainImage& out) {
    VkImageCreateInfo image{};
    image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    image.imageType = VK_IMAGE_TYPE_2D;
    image.format = static_cast<VkFormat>(info.format);
    image.extent = {info.width, info.height, 1};
    image.mipLevels = info.mipCount;
    image.arrayLayers = info.arraySize * info.faceCount;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    image.tiling = VK_IMAGE_TILING_OPTIMAL;
    image.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;  // the mock reads the pictures
    const auto use = [&](XrSwapchainUsageFlags flag, VkImageUsageFlags usage) {
        if ((info.usageFlags & flag) != 0) image.usage |= usage;
    };
    use(XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    use(XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    use(XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    use(XR_SWAPCHAIN_USAGE_SAMPLED_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    if (const VkResult result = vk.CreateImage(vk.device, &image, nullptr, &out.image)) return result;
    VkMemoryRequirements needs{};
    vk.GetImageMemoryRequirements(vk.device, out.image, &needs);
    if (const VkResult result = allocate(vk, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, out.memory))
        return result;
    return vk.BindImageMemory(vk.device, out.image, out.memory, 0);
}

void destroy_image(const Vulkan& vk, const SwapchainImage& image) {
    if (image.image != VK_NULL_HANDLE) vk.DestroyImage(vk.device, image.image, nullptr);
    if (image.memory != VK_NULL_HANDLE) vk.FreeMemory(vk.device, image.memory, nullptr);
}

VkResult prepare_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, SwapchainImage& image) {
    if (image.prepared) return VK_SUCCESS;
    image.prepared = true;
    return run(vk, [&](VkCommandBuffer commands) {
        barrier(vk, commands, image.image, info, VK_IMAGE_LAYOUT_UNDEFINED, client_layout(info));
    });
}

VkResult read_image(const Vulkan& vk, const XrSwapchainCreateInfo& info, VkImage image, std::uint32_t layer,
                    const XrRect2Di& rect, std::vector<std::uint8_t>& bytes) {
    const auto format = static_cast<VkFormat>(info.format);
    const auto width = static_cast<std::uint32_t>(rect.extent.width),
               height = static_cast<std::uint32_t>(rect.extent.height);
    bytes.resize(std::size_t{width} * height * texel_size(format));
    ReadBuffer buffer;
    VkResult result = create_buffer(vk, bytes.size(), buffer);
    if (result == VK_SUCCESS) {
        result = run(vk, [&](VkCommandBuffer commands) {
            barrier(vk, commands, image, info, client_layout(info), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
            VkBufferImageCopy region{};
            region.imageSubresource = {
                VkImageAspectFlags{is_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT},
                0, layer, 1};
            region.imageOffset = {rect.offset.x, rect.offset.y, 0};
            region.imageExtent = {width, height, 1};
            vk.CmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.buffer, 1,
                                    &region);
            barrier(vk, commands, image, info, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, client_layout(info));
        });
    }
    void* mapped = nullptr;
    if (result == VK_SUCCESS) result = vk.MapMemory(vk.device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    if (result == VK_SUCCESS) {
        std::memcpy(bytes.data(), mapped, bytes.size());
        vk.UnmapMemory(vk.device, buffer.memory);
    }
    if (buffer.buffer != VK_NULL_HANDLE) vk.DestroyBuffer(vk.device, buffer.buffer, nullptr);
    if (buffer.memory != VK_NULL_HANDLE) vk.FreeMemory(vk.device, buffer.memory, nullptr);
    return result;
}

std::vector<std::uint8_t> to_rgba8(VkFormat format, const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint8_t> rgba = bytes;
    switch (format) {
        case VK_FORMAT_R8G8B8A8_SRGB:
            return rgba;
        case VK_FORMAT_B8G8R8A8_SRGB:
            for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) std::swap(rgba[i], rgba[i + 2]);
            return rgba;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R16G16B16A16_UNORM:
            break;
        default:
            return {};
    }
    rgba.resize(bytes.size() / 2);
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        std::uint16_t raw = 0;
        std::memcpy(&raw, bytes.data() + 2 * i, 2);
        const float value =
            format == VK_FORMAT_R16G16B16A16_UNORM ? static_cast<float>(raw) / 65535.0F : half_to_float(raw);
        rgba[i] = i % 4 == 3 ? static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)))
                             : encode_srgb(value);
    }
    return rgba;
}

}  // namespace bolt::mock
