// All barriers of the engine. A barrier moves a resource from one use to another; one table defines the
// pipeline stages, accesses and image layout of each use.
#pragma once

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

enum class ResourceUse : std::uint8_t {
    undefined,      // newly created
    acquired,       // from the swapchain, with undefined contents; the acquire semaphore is waited for before
                    // copies
    color_target,   // drawn or resolved into
    depth_target,   // tested and written
    depth_read,     // tested and sampled at the same time
    sampled,        // read in fragment or compute shaders
    storage_write,  // written (and read) in compute shaders
    vertex_read,    // vertex and index buffers, and buffers read in vertex shaders
    uniform_read,   // buffers read in any shader
    transfer_from,
    transfer_to,
    host_read,  // read by the CPU after the fence
    present,
};

struct ResourceUseInfo {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

ResourceUseInfo use_info(ResourceUse use);

struct ImageRange {
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
    std::uint32_t first_mip = 0, mips = VK_REMAINING_MIP_LEVELS;
    std::uint32_t first_layer = 0, layers = VK_REMAINING_ARRAY_LAYERS;
};

void image_barrier(VkCommandBuffer commands, VkImage image, ResourceUse from, ResourceUse to,
                   const ImageRange& range = {});

// The same for an image whose contents may be lost: waits for the last use, then discards what it wrote. For
// targets that are redrawn each frame while the previous frame may still be read.
void image_barrier_discarding(VkCommandBuffer commands, VkImage image, ResourceUse last, ResourceUse to,
                              const ImageRange& range = {});

// A barrier for all buffers: buffers have no layout, and a global memory barrier costs the same as a buffer
// barrier.
void memory_barrier(VkCommandBuffer commands, ResourceUse from, ResourceUse to);

}  // namespace bolt::gpu
