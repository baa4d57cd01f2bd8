// Every barrier of the engine, and nothing else about synchronization. A resource is moved from one use to
// another; what a use means in stages, accesses and image layout stands in one table.
#pragma once

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

enum class Use : std::uint8_t {
    undefined,      // new: nobody has used it
    acquired,       // from the swapchain, contents unknown; the semaphore waits before copies
    color_target,   // drawn into, resolved into
    depth_target,   // tested and written
    depth_read,     // tested, and sampled at the same time
    sampled,        // read in fragment or compute shaders
    storage_write,  // written (and read) in compute shaders
    vertex_read,    // vertex and index buffers, and buffers read in vertex shaders
    uniform_read,   // buffers read in any shader
    transfer_from,
    transfer_to,
    host_read,  // read by the CPU after the fence
    present,
};

struct UseMeans {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

UseMeans means(Use use);

struct ImageRange {
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    std::uint32_t first_mip = 0, mips = VK_REMAINING_MIP_LEVELS;
    std::uint32_t first_layer = 0, layers = VK_REMAINING_ARRAY_LAYERS;
};

void image_barrier(VkCommandBuffer commands, VkImage image, Use from, Use to, const ImageRange& range = {});

// The same for an image whose contents need not survive: what the last use wrote is waited for and then
// forgotten. Targets that are drawn anew each frame, while the frame before may still be read.
void image_barrier_discarding(VkCommandBuffer commands, VkImage image, Use last, Use to,
                              const ImageRange& range = {});

// For all buffers at once: buffers have no layout, and one barrier of memory costs what one of a buffer does.
void memory_barrier(VkCommandBuffer commands, Use from, Use to);

}  // namespace bolt::gpu
