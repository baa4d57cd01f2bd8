// Collects the resources of a descriptor set and writes them in one call.
#pragma once

#include <deque>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/pipeline.hpp"

namespace bolt::gpu {

class DescriptorWriter {
  public:
    // Allocates a set with the pipeline's layout that lives as long as the frame.
    static Result<DescriptorWriter> create(Device& device, FrameContext& frame, const Pipeline& pipeline,
                                           std::uint32_t set);

    DescriptorWriter& buffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size);
    DescriptorWriter& range(std::uint32_t binding, const TransientRange& range) {
        return buffer(binding, range.buffer, range.offset, range.bytes.size());
    }
    DescriptorWriter& image(std::uint32_t binding, VkImageView view, VkSampler sampler,
                            VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

    // Sets all elements of an array binding.
    DescriptorWriter& images(std::uint32_t binding, std::span<const VkDescriptorImageInfo> images);

    // Writes the set and returns it. Fails if a binding of the shader was not set or a set binding does not
    // exist in it.
    Result<VkDescriptorSet> finish();

  private:
    Device* device_ = nullptr;
    const Pipeline* pipeline_ = nullptr;
    std::uint32_t set_index_ = 0;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::deque<VkDescriptorBufferInfo>
        buffers_;  // a deque, because the writes hold addresses of its elements
    std::deque<std::vector<VkDescriptorImageInfo>> images_;
    std::vector<VkWriteDescriptorSet> writes_;
};

}  // namespace bolt::gpu
