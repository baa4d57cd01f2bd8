#include "engine/gpu/transfer.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace bolt::gpu {

Status submit_and_wait(Device& device, const std::function<void(VkCommandBuffer)>& record) {
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.queue_family();
    VkCommandPool raw_pool = VK_NULL_HANDLE;
    if (Status made = check(vkCreateCommandPool(device.get(), &pool_info, nullptr, &raw_pool),
                            "creating a command pool");
        !made)
        return made;
    const CommandPool pool(device.get(), raw_pool);
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pool.get();
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    if (Status made = check(vkAllocateCommandBuffers(device.get(), &allocate, &commands),
                            "allocating a command buffer");
        !made)
        return made;

    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    BOLT_TRY(check(vkBeginCommandBuffer(commands, &begin), "recording commands"));
    record(commands);
    BOLT_TRY(check(vkEndCommandBuffer(commands), "recording commands"));

    VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence raw_fence = VK_NULL_HANDLE;
    if (Status made =
            check(vkCreateFence(device.get(), &fence_info, nullptr, &raw_fence), "creating a fence");
        !made)
        return made;
    const Fence fence(device.get(), raw_fence);
    VkCommandBufferSubmitInfo submitted{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    submitted.commandBuffer = commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &submitted;
    if (Status sent = check(vkQueueSubmit2(device.queue(), 1, &submit, fence.get()), "submitting commands");
        !sent)
        return sent;
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
