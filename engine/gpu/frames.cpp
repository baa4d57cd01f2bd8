#include "engine/gpu/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace bolt::gpu {

namespace {

constexpr VkDeviceSize initial_transient_size = VkDeviceSize{1} << 20;
constexpr std::uint32_t max_timings = 64;
constexpr std::uint32_t sets_per_pool = 256;

Result<Buffer> make_transient_buffer(Device& device, VkDeviceSize size) {
    return Buffer::create(device, size,
                          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                              VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
                              VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                          MemoryUse::upload);
}

Result<Fence> make_signalled_fence(Device& device) {
    VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    info.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    VkFence fence = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateFence(device.get(), &info, nullptr, &fence), "creating a fence"));
    return Fence(device.get(), fence);
}

}  // namespace

Status FrameContext::prepare(Device& device) {
    device_ = &device;
    VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool_info.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool_info.queueFamilyIndex = device.queue_family();
    VkCommandPool pool = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateCommandPool(device.get(), &pool_info, nullptr, &pool), "creating a command pool"));
    pool_ = CommandPool(device.get(), pool);

    VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    commands.commandPool = pool;
    commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands.commandBufferCount = 1;
    BOLT_TRY(
        check(vkAllocateCommandBuffers(device.get(), &commands, &commands_), "allocating a command buffer"));

    BOLT_TRY_ASSIGN(fence_, make_signalled_fence(device));

    if (device.limits().timestampComputeAndGraphics == VK_TRUE) {
        VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
        queries.queryCount = 2 * max_timings;
        VkQueryPool query_pool = VK_NULL_HANDLE;
        BOLT_TRY(
            check(vkCreateQueryPool(device.get(), &queries, nullptr, &query_pool), "creating a query pool"));
        queries_ = QueryPool(device.get(), query_pool);
    }
    BOLT_TRY_ASSIGN(auto buffer, make_transient_buffer(device, initial_transient_size));
    transient_buffer_ = std::move(buffer);
    return add_descriptor_pool();
}

Status FrameContext::add_descriptor_pool() {
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2 * sets_per_pool},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 4 * sets_per_pool},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 * sets_per_pool},
                                          {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sets_per_pool}};
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = sets_per_pool;
    info.poolSizeCount = static_cast<std::uint32_t>(std::size(sizes));
    info.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    BOLT_TRY(
        check(vkCreateDescriptorPool(device_->get(), &info, nullptr, &pool), "creating a descriptor pool"));
    descriptor_pools_.emplace_back(device_->get(), pool);
    return {};
}

Result<TransientRange> FrameContext::allocate(VkDeviceSize size) {
    const VkDeviceSize alignment =
        std::max({device_->limits().minUniformBufferOffsetAlignment,
                  device_->limits().minStorageBufferOffsetAlignment, VkDeviceSize{16}});
    VkDeviceSize offset = (transient_used_ + alignment - 1) & ~(alignment - 1);
    if (offset + size > transient_buffer_.size()) {
        BOLT_TRY_ASSIGN(auto larger,
                        make_transient_buffer(*device_, std::max(2 * transient_buffer_.size(), size)));
        retired_.add(std::exchange(transient_buffer_, std::move(larger)));
        offset = 0;
    }
    transient_used_ = offset + size;
    return TransientRange{
        transient_buffer_.get(), offset,
        transient_buffer_.bytes().subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(size))};
}

Result<VkDescriptorSet> FrameContext::descriptor_set(VkDescriptorSetLayout layout) {
    for (int attempt = 0;; ++attempt) {
        VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
        info.descriptorPool = descriptor_pools_[descriptor_pool_].get();
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult result = vkAllocateDescriptorSets(device_->get(), &info, &set);
        if (result == VK_SUCCESS) return set;
        const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
        if (!full || attempt > 0) return fail(check(result, "allocating a descriptor set").error());
        if (++descriptor_pool_ == descriptor_pools_.size()) BOLT_TRY(add_descriptor_pool());
    }
}

void FrameContext::begin_timing(std::string name) {
    if (!queries_) return;
    open_timings_.push_back(timing_names_.size());
    if (timing_names_.size() == max_timings) return;
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                         static_cast<std::uint32_t>(2 * timing_names_.size()));
    timing_names_.push_back(std::move(name));
}

void FrameContext::end_timing() {
    if (open_timings_.empty()) return;
    const std::size_t timing = open_timings_.back();
    open_timings_.pop_back();
    if (timing == max_timings) return;  // begun when all queries were in use
    const auto query = static_cast<std::uint32_t>(2 * timing + 1);
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), query);
}

void FrameContext::read_timings() {
    timings_.clear();
    for (std::size_t i = 0; i < timing_names_.size(); ++i) {
        std::uint64_t ticks[2] = {0, 0};
        const VkResult result =
            vkGetQueryPoolResults(device_->get(), queries_.get(), static_cast<std::uint32_t>(2 * i), 2,
                                  sizeof ticks, ticks, sizeof ticks[0], VK_QUERY_RESULT_64_BIT);
        if (result != VK_SUCCESS) continue;
        const double period = static_cast<double>(device_->limits().timestampPeriod);
        timings_.push_back({timing_names_[i], static_cast<double>(ticks[1] - ticks[0]) * period * 1e-6});
    }
    timing_names_.clear();
    open_timings_.clear();
}

Status FrameContext::reset() {
    const VkFence fence = fence_.get();
    const VkResult waited =
        vkWaitForFences(device_->get(), 1, &fence, VK_TRUE, std::numeric_limits<std::uint64_t>::max());
    BOLT_TRY(check(waited, "waiting for a frame"));
    read_timings();
    retired_.destroy();
    transient_used_ = 0;
    for (const DescriptorPool& pool : descriptor_pools_) vkResetDescriptorPool(device_->get(), pool.get(), 0);
    descriptor_pool_ = 0;
    return check(vkResetCommandPool(device_->get(), pool_.get(), 0), "resetting the command pool");
}

Result<std::unique_ptr<Frames>> Frames::create(Device& device) {
    auto frames = std::make_unique<Frames>();
    frames->device_ = &device;
    for (FrameContext& frame : frames->frames_) BOLT_TRY(frame.prepare(device));
    return frames;
}

Result<FrameContext*> Frames::begin() {
    FrameContext& frame = frames_[next_];
    BOLT_TRY(frame.reset());
    if (!frame.timings_.empty()) timings_ = frame.timings_;
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    BOLT_TRY(check(vkBeginCommandBuffer(frame.commands_, &info), "recording a frame"));
    if (frame.queries_) vkCmdResetQueryPool(frame.commands_, frame.queries_.get(), 0, 2 * max_timings);
    return &frame;
}

Status Frames::submit(FrameContext& frame, const Signals& signals) {
    while (!frame.open_timings_.empty()) frame.end_timing();
    BOLT_TRY(check(vkEndCommandBuffer(frame.commands_), "recording a frame"));
    const VkFence fence = frame.fence_.get();
    BOLT_TRY(check(vkResetFences(device_->get(), 1, &fence), "resetting a fence"));

    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = frame.commands_;
    const auto semaphores = [](std::span<const VkSemaphore> all, VkPipelineStageFlags2 stages) {
        std::vector<VkSemaphoreSubmitInfo> infos;
        for (const VkSemaphore semaphore : all) {
            infos.push_back({VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO});
            infos.back().semaphore = semaphore;
            infos.back().stageMask = stages;
        }
        return infos;
    };
    // Pictures are copied into the swapchains.
    const auto waits = semaphores(signals.wait, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT),
               signalled = semaphores(signals.signal, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    VkSubmitInfo2 info{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    info.commandBufferInfoCount = 1;
    info.pCommandBufferInfos = &commands;
    info.waitSemaphoreInfoCount = static_cast<std::uint32_t>(waits.size());
    info.pWaitSemaphoreInfos = waits.data();
    info.signalSemaphoreInfoCount = static_cast<std::uint32_t>(signalled.size());
    info.pSignalSemaphoreInfos = signalled.data();
    next_ = (next_ + 1) % frames_in_flight;
    const Status submitted = check(vkQueueSubmit2(device_->queue(), 1, &info, fence), "submitting a frame");
    if (submitted) return {};
    // No work will signal the fence, so the next wait for it would never end.
    BOLT_TRY_ASSIGN(frame.fence_, make_signalled_fence(*device_));
    return submitted;
}

Status Frames::finish() {
    for (std::uint32_t i = 0; i < frames_in_flight; ++i) {
        FrameContext& frame = frames_[(next_ + i) % frames_in_flight];  // the oldest one first
        BOLT_TRY(frame.reset());
        if (!frame.timings_.empty()) timings_ = frame.timings_;
    }
    return {};
}

Result<DescriptorWriter> DescriptorWriter::create(Device& device, FrameContext& frame,
                                                  const Pipeline& pipeline, std::uint32_t set) {
    DescriptorWriter writer;
    writer.device_ = &device;
    writer.pipeline_ = &pipeline;
    writer.set_index_ = set;
    if (set >= pipeline.sets.size())
        return fail(ErrorCode::failed, fmt::format("the pipeline has no descriptor set {}", set),
                    "a set that its shaders declare");
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
    const VkDescriptorImageInfo info{sampler, view, layout};
    return images(binding, {&info, 1});
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
                        fmt::format("no shader has set {} binding {}", set_index_, write.dstBinding),
                        "a binding that a shader declares");
        write.descriptorType = known->type;
        write.dstSet = set_;
    }
    for (const Binding& binding : pipeline_->bindings) {
        const bool written = std::any_of(
            writes_.begin(), writes_.end(),
            [&](const VkWriteDescriptorSet& write) { return write.dstBinding == binding.binding; });
        if (binding.set == set_index_ && !written)
            return fail(ErrorCode::failed,
                        fmt::format("nothing is bound to \"{}\" (set {} binding {})", binding.name,
                                    binding.set, binding.binding),
                        "a resource for each binding");
    }
    vkUpdateDescriptorSets(device_->get(), static_cast<std::uint32_t>(writes_.size()), writes_.data(), 0,
                           nullptr);
    return set_;
}

}  // namespace bolt::gpu
