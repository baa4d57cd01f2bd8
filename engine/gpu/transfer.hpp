// Getting data to the GPU and back outside a frame: loading and tests. Each call waits until it is done.
#pragma once

#include <functional>

#include "engine/gpu/barrier.hpp"
#include "engine/gpu/resources.hpp"

namespace bolt::gpu {

// Records commands, runs them and waits.
Status run_now(Device& device, const std::function<void(VkCommandBuffer)>& record);

// A buffer in the GPU's memory with these bytes.
Result<Buffer> upload_buffer(Device& device, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

// Fills mip 0 of every layer, layers one after the other in `texels`, makes the other mips by halving, and
// leaves the image `sampled`. Needs transfer usages both ways; the format must allow linear blits if there
// are mips.
Status upload_image(Device& device, Image& image, std::span<const std::byte> texels);

// The texels of one mip of one layer of an image that is in use `from`, which it is in again afterwards.
Result<std::vector<std::byte>> download_image(Device& device, const Image& image, Use from,
                                              std::uint32_t texel_size, std::uint32_t mip = 0,
                                              std::uint32_t layer = 0);

}  // namespace bolt::gpu
