// Filling a descriptor set: bind what each binding of the pipeline wants, then write once.
#pragma once

#include <deque>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/pipeline.hpp"

namespace bolt::gpu {

class SetWriter {
  public:
    // A set of the pipeline's layout, alive as long as the frame.
    static Result<SetWriter> create(Device& device, Frame& frame, const Pipeline& pipeline,
                                    std::uint32_t set);

    SetWriter& buffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize size);
    SetWriter& piece(std::uint32_t binding, const Piece& piece) {
        return buffer(binding, piece.buffer, piece.offset, piece.bytes.size());
    }
    SetWriter& image(std::uint32_t binding, VkImageView view, VkSampler sampler,
                     VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

    // All elements of a binding that is an array.
    SetWriter& images(std::uint32_t binding, std::span<const VkDescriptorImageInfo> images);

    // The finished set; an error names a binding of the shader that was left out, or one that it does not
    // have.
    Result<VkDescriptorSet> finish();

  private:
    Device* device_ = nullptr;
    const Pipeline* pipeline_ = nullptr;
    std::uint32_t set_index_ = 0;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::deque<VkDescriptorBufferInfo> buffers_;  // addresses stay
    std::deque<std::vector<VkDescriptorImageInfo>> images_;
    std::vector<VkWriteDescriptorSet> writes_;
};

}  // namespace bolt::gpu
