// Transfers to and from the GPU outside of frames, for loading and tests. Each call waits until it is
// complete.
#pragma once

#include <functional>

#include "engine/gpu/barrier.hpp"
#include "engine/gpu/resources.hpp"

namespace bolt::gpu {

// Records commands, submits them and waits for their completion.
Status submit_and_wait(Device& device, const std::function<void(VkCommandBuffer)>& record);

// Creates a buffer in device memory with these bytes.
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

// Fills mip 0 of every layer from `texels` (layers one after the other), generates the other mips by halving,
// and leaves the image in use `sampled`. Needs both transfer usages; if there are mips, the format must
// support linear blits.
Status upload_image(Device& device, Image& image, std::span<const std::byte> texels);

// Reads the texels of one mip of one layer. The image is in use `from` before and afterwards.
Result<std::vector<std::byte>> download_image(Device& device, const Image& image, ResourceUse from,
                                              std::uint32_t texel_size, std::uint32_t mip = 0,
                                              std::uint32_t layer = 0);

}  // namespace bolt::gpu
