#include "engine/gpu/descriptors.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::gpu {

Result<DescriptorWriter> DescriptorWriter::create(Device& device, FrameContext& frame,
                                                  const Pipeline& pipeline, std::uint32_t set) {
    DescriptorWriter writer;
    writer.device_ = &device;
    writer.pipeline_ = &pipeline;
    writer.set_index_ = set;
    if (set >= pipeline.sets.size())
        return fail(ErrorCode::failed, fmt::format("the pipeline has no descriptor set {}", set));
    BOLT_TRY_ASSIGN(auto allocated, frame.descriptor_set(pipeline.sets[set].get()));
    writer.set_ = allocated;
    return writer;
}

DescriptorWriter& DescriptorWriter::buffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset,
                                           VkDeviceSize size) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.pBufferInfo = &buffers_.emplace_back(VkDescriptorBufferInfo{buffer, offset, size});
    writes_.push_back(write);
    return *this;
}

DescriptorWriter& DescriptorWriter::image(std::uint32_t binding, VkImageView view, VkSampler sampler,
                                          VkImageLayout layout) {
    const VkDescriptorImageInfo one{sampler, view, layout};
    return images(binding, {&one, 1});
}

DescriptorWriter& DescriptorWriter::images(std::uint32_t binding,
                                           std::span<const VkDescriptorImageInfo> images) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstBinding = binding;
    write.descriptorCount = static_cast<std::uint32_t>(images.size());
    write.pImageInfo = images_.emplace_back(images.begin(), images.end()).data();
    writes_.push_back(write);
    return *this;
}

Result<VkDescriptorSet> DescriptorWriter::finish() {
    for (VkWriteDescriptorSet& write : writes_) {
        const auto known =
            std::find_if(pipeline_->bindings.begin(), pipeline_->bindings.end(), [&](const Binding& binding) {
                return binding.set == set_index_ && binding.binding == write.dstBinding;
            });
        if (known == pipeline_->bindings.end())
            return fail(ErrorCode::failed,
                        fmt::format("no shader has set {} binding {}", set_index_, write.dstBinding));
        write.descriptorType = known->type;
        write.dstSet = set_;
    }
    for (const Binding& binding : pipeline_->bindings) {
        const bool written = std::any_of(
            writes_.begin(), writes_.end(),
            [&](const VkWriteDescriptorSet& write) { return write.dstBinding == binding.binding; });
        if (binding.set == set_index_ && !written)
            return fail(ErrorCode::failed, fmt::format("nothing is bound to \"{}\" (set {} binding {})",
                                                       binding.name, binding.set, binding.binding));
    }
    vkUpdateDescriptorSets(device_->get(), static_cast<std::uint32_t>(writes_.size()), writes_.data(), 0,
                           nullptr);
    return set_;
}

}  // namespace bolt::gpu
