#include "engine/gpu/resources.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace bolt::gpu {

Result<Buffer> Buffer::create(Device& device, VkDeviceSize size, VkBufferUsageFlags usage, MemoryUse use) {
    Buffer buffer;
    buffer.device_ = &device;
    buffer.size_ = std::max<VkDeviceSize>(size, 4);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = buffer.size_;
    info.usage = usage;
    BOLT_TRY(check(vkCreateBuffer(device.get(), &info, nullptr, &buffer.buffer_), "creating a buffer"));
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.get(), buffer.buffer_, &needs);
    BOLT_TRY_ASSIGN(auto allocation, device.memory().allocate(needs, use, Memory::Tiling::linear));
    buffer.allocation_ = allocation;
    const VkResult bound = vkBindBufferMemory(device.get(), buffer.buffer_, buffer.allocation_.memory,
                                              buffer.allocation_.offset);
    BOLT_TRY(check(bound, "binding a buffer"));
    return buffer;
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(size_, other.size_);
    std::swap(allocation_, other.allocation_);
}

Buffer::~Buffer() {
    if (device_ == nullptr) return;
    vkDestroyBuffer(device_->get(), buffer_, nullptr);
    device_->memory().free(allocation_);
}

VkImageAspectFlags ImageInfo::aspect() const {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

Result<Image> Image::create(Device& device, const ImageInfo& requested) {
    Image image;
    image.device_ = &device;
    image.info_ = requested;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    if (requested.cube) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
    if (requested.storage_format != VK_FORMAT_UNDEFINED)
        info.flags |= VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = requested.format;
    info.extent = {requested.extent.width, requested.extent.height, 1};
    info.mipLevels = requested.mips;
    info.arrayLayers = requested.layers;
    info.samples = requested.samples;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = requested.usage;
    BOLT_TRY(check(vkCreateImage(device.get(), &info, nullptr, &image.image_), "creating an image"));
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.get(), image.image_, &needs);
    BOLT_TRY_ASSIGN(auto allocation,
                    device.memory().allocate(needs, MemoryUse::device, Memory::Tiling::optimal));
    image.allocation_ = allocation;
    const VkResult bound =
        vkBindImageMemory(device.get(), image.image_, image.allocation_.memory, image.allocation_.offset);
    BOLT_TRY(check(bound, "binding an image"));

    BOLT_TRY(image.make_whole_views());
    return image;
}

Status Image::make_whole_views() {
    const VkImageViewType type = info_.cube                        ? VK_IMAGE_VIEW_TYPE_CUBE
                                 : info_.layers > 1 || info_.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                                   : VK_IMAGE_VIEW_TYPE_2D;
    BOLT_TRY_ASSIGN(view_, view(type, 0, info_.mips, 0, info_.layers));
    if ((info_.usage & VK_IMAGE_USAGE_STORAGE_BIT) == 0) return {};
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.viewType = type;
    info.format = info_.storage_format != VK_FORMAT_UNDEFINED ? info_.storage_format : info_.format;
    info.subresourceRange = {info_.aspect(), 0, 1, 0, info_.layers};
    BOLT_TRY_ASSIGN(storage_view_, make_view(info, VK_IMAGE_USAGE_STORAGE_BIT));
    return {};
}

Result<ImageView> Image::view(VkImageViewType type, std::uint32_t first_mip, std::uint32_t mips,
                              std::uint32_t first_layer, std::uint32_t layers) const {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.viewType = type;
    info.format = info_.format;
    info.subresourceRange = {info_.aspect(), first_mip, mips, first_layer, layers};
    return make_view(info, info_.usage & ~VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT});
}

// `usage`: the usage of the view. The format of a view may not allow all usages of the image.
Result<ImageView> Image::make_view(VkImageViewCreateInfo info, VkImageUsageFlags usage) const {
    VkImageViewUsageCreateInfo usage_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO};
    usage_info.usage = usage;
    info.pNext = &usage_info;
    info.image = image_;
    VkImageView view = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateImageView(device_->get(), &info, nullptr, &view), "creating an image view"));
    return ImageView(device_->get(), view);
}

void Image::swap(Image& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(info_, other.info_);
    std::swap(allocation_, other.allocation_);
    std::swap(view_, other.view_);
    std::swap(storage_view_, other.storage_view_);
}

Image::~Image() {
    if (device_ == nullptr) return;
    view_ = {};
    storage_view_ = {};
    vkDestroyImage(device_->get(), image_, nullptr);
    device_->memory().free(allocation_);
}

Result<Sampler> make_sampler(const Device& device, const SamplerInfo& requested) {
    VkPhysicalDeviceFeatures features{};
    vkGetPhysicalDeviceFeatures(device.physical(), &features);
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = requested.filter;
    info.minFilter = requested.min_filter.value_or(requested.filter);
    info.mipmapMode =
        requested.mips.value_or(requested.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                                     : VK_SAMPLER_MIPMAP_MODE_NEAREST);
    info.addressModeU = info.addressModeW = requested.address;
    info.addressModeV = requested.address_v.value_or(requested.address);
    // On llvmpipe (Mesa 22.3) anisotropic filtering took one millisecond per pixel, that is minutes per
    // picture.
    const bool software = device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info.anisotropyEnable = requested.anisotropy > 1.0F && !software ? features.samplerAnisotropy : VK_FALSE;
    info.maxAnisotropy = std::min(requested.anisotropy, device.limits().maxSamplerAnisotropy);
    info.compareEnable = requested.compares ? VK_TRUE : VK_FALSE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    info.maxLod = VK_LOD_CLAMP_NONE;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VkSampler sampler = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateSampler(device.get(), &info, nullptr, &sampler), "creating a sampler"));
    return Sampler(device.get(), sampler);
}

ResourceUseInfo use_info(ResourceUse use) {
    constexpr VkPipelineStageFlags2 shaders =
        VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    constexpr VkPipelineStageFlags2 depth =
        VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
    switch (use) {
        case ResourceUse::undefined:
            return {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
        case ResourceUse::acquired:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
        case ResourceUse::color_target:
            return {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        case ResourceUse::depth_target:
            // A multisampled depth attachment is resolved in the colour output stage, whatever its format.
            return {depth | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                        VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
                        VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
        case ResourceUse::depth_read:
            return {depth | shaders,
                    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                    VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
        case ResourceUse::sampled:
            return {shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        case ResourceUse::storage_write:
            return {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                    VK_IMAGE_LAYOUT_GENERAL};
        case ResourceUse::vertex_read:
            return {VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                    VK_ACCESS_2_INDEX_READ_BIT | VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT |
                        VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                    VK_IMAGE_LAYOUT_UNDEFINED};
        case ResourceUse::uniform_read:
            return {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | shaders,
                    VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                    VK_IMAGE_LAYOUT_UNDEFINED};
        case ResourceUse::transfer_from:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
        case ResourceUse::transfer_to:
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
        case ResourceUse::host_read:
            return {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_GENERAL};
        case ResourceUse::present:
            // The present semaphore makes the writes visible, so the barrier changes the layout only.
            return {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
    }
    return {};
}

namespace {

void barrier(VkCommandBuffer commands, VkImage image, const ResourceUseInfo& before,
             const ResourceUseInfo& after, const ImageRange& range) {
    VkImageMemoryBarrier2 info{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    info.srcStageMask = before.stages;
    info.srcAccessMask = before.access;
    info.dstStageMask = after.stages;
    info.dstAccessMask = after.access;
    info.oldLayout = before.layout;
    info.newLayout = after.layout;
    info.srcQueueFamilyIndex = info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    info.image = image;
    info.subresourceRange = {range.aspect, range.first_mip, range.mips, range.first_layer, range.layers};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &info;
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

void image_barrier(VkCommandBuffer commands, VkImage image, ResourceUse from, ResourceUse to,
                   const ImageRange& range) {
    barrier(commands, image, use_info(from), use_info(to), range);
}

void image_barrier_discarding(VkCommandBuffer commands, VkImage image, ResourceUse last, ResourceUse to,
                              const ImageRange& range) {
    ResourceUseInfo before = use_info(last);
    before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    barrier(commands, image, before, use_info(to), range);
}

void memory_barrier(VkCommandBuffer commands, ResourceUse from, ResourceUse to) {
    const ResourceUseInfo before = use_info(from), after = use_info(to);
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.access;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

Status submit_and_wait(Device& device, const std::function<void(VkCommandBuffer)>& record) {
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.queue_family();
    VkCommandPool raw_pool = VK_NULL_HANDLE;
    BOLT_TRY(
        check(vkCreateCommandPool(device.get(), &pool_info, nullptr, &raw_pool), "creating a command pool"));
    const CommandPool pool(device.get(), raw_pool);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool.get();
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    BOLT_TRY(
        check(vkAllocateCommandBuffers(device.get(), &allocate, &commands), "allocating a command buffer"));

    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    BOLT_TRY(check(vkBeginCommandBuffer(commands, &begin), "recording commands"));
    record(commands);
    BOLT_TRY(check(vkEndCommandBuffer(commands), "recording commands"));

    VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence raw_fence = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateFence(device.get(), &fence_info, nullptr, &raw_fence), "creating a fence"));
    const Fence fence(device.get(), raw_fence);
    VkCommandBufferSubmitInfo submitted{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    submitted.commandBuffer = commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &submitted;
    BOLT_TRY(check(vkQueueSubmit2(device.queue(), 1, &submit, fence.get()), "submitting commands"));
    const VkResult waited =
        vkWaitForFences(device.get(), 1, &raw_fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    return check(waited, "waiting for commands");
}

Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
    BOLT_TRY_ASSIGN(auto staging, Buffer::create(device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                 MemoryUse::upload));
    std::memcpy(staging.bytes().data(), bytes.data(), bytes.size());
    Result<Buffer> buffer =
        Buffer::create(device, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::device);
    if (!buffer || bytes.empty()) return buffer;
    BOLT_TRY(submit_and_wait(device, [&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, bytes.size()};
        vkCmdCopyBuffer(commands, staging.get(), buffer->get(), 1, &region);
        memory_barrier(commands, ResourceUse::transfer_to, ResourceUse::vertex_read);
        memory_barrier(commands, ResourceUse::transfer_to, ResourceUse::uniform_read);
    }));
    return buffer;
}

Status upload_image(Device& device, Image& image, std::span<const std::byte> texels) {
    const ImageInfo& info = image.info();
    BOLT_TRY_ASSIGN(auto staging, Buffer::create(device, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                 MemoryUse::upload));
    std::memcpy(staging.bytes().data(), texels.data(), texels.size());
    return submit_and_wait(device, [&](VkCommandBuffer commands) {
        image_barrier(commands, image.get(), ResourceUse::undefined, ResourceUse::transfer_to);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, info.layers};
        region.imageExtent = {info.extent.width, info.extent.height, 1};
        vkCmdCopyBufferToImage(commands, staging.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &region);
        auto width = static_cast<std::int32_t>(info.extent.width),
             height = static_cast<std::int32_t>(info.extent.height);
        for (std::uint32_t mip = 1; mip < info.mips; ++mip) {
            image_barrier(commands, image.get(), ResourceUse::transfer_to, ResourceUse::transfer_from,
                          {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 1, 0, info.layers});
            VkImageBlit blit{};
            blit.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip - 1, 0, info.layers};
            blit.srcOffsets[1] = {width, height, 1};
            width = std::max(width / 2, 1);
            height = std::max(height / 2, 1);
            blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, info.layers};
            blit.dstOffsets[1] = {width, height, 1};
            vkCmdBlitImage(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
        }
        if (info.mips > 1)
            image_barrier(commands, image.get(), ResourceUse::transfer_from, ResourceUse::sampled,
                          {VK_IMAGE_ASPECT_COLOR_BIT, 0, info.mips - 1, 0, info.layers});
        image_barrier(commands, image.get(), ResourceUse::transfer_to, ResourceUse::sampled,
                      {VK_IMAGE_ASPECT_COLOR_BIT, info.mips - 1, 1, 0, info.layers});
    });
}

Result<std::vector<std::byte>> download_image(Device& device, const Image& image, ResourceUse from,
                                              std::uint32_t texel_size, std::uint32_t mip,
                                              std::uint32_t layer) {
    const ImageInfo& info = image.info();
    const std::uint32_t width = std::max(info.extent.width >> mip, 1U),
                        height = std::max(info.extent.height >> mip, 1U);
    const VkDeviceSize size = VkDeviceSize{width} * height * texel_size;
    BOLT_TRY_ASSIGN(auto buffer,
                    Buffer::create(device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback));
    BOLT_TRY(submit_and_wait(device, [&](VkCommandBuffer commands) {
        const ImageRange range{info.aspect(), mip, 1, layer, 1};
        image_barrier(commands, image.get(), from, ResourceUse::transfer_from, range);
        VkBufferImageCopy region{};
        region.imageSubresource = {info.aspect(), mip, layer, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.get(), 1,
                               &region);
        image_barrier(commands, image.get(), ResourceUse::transfer_from, from, range);
        memory_barrier(commands, ResourceUse::transfer_to, ResourceUse::host_read);
    }));
    const std::span<const std::byte> bytes = buffer.bytes().first(static_cast<std::size_t>(size));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

}  // namespace bolt::gpu
