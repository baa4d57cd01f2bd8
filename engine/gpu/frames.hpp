// Frames in flight: the CPU records one frame while the GPU draws another. Each frame has its own command
// buffer, fence, transient memory, descriptor sets, timestamps and retired resources.
#pragma once

#include <array>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/gpu/pipeline.hpp"
#include "engine/gpu/resources.hpp"

namespace bolt::gpu {

inline constexpr std::uint32_t frames_in_flight = 2;

// The GPU time of one pass of a frame.
struct PassTiming {
    std::string name;
    double milliseconds = 0.0;
};

// A range of a frame's transient buffer: written by the CPU now, read by the GPU in this frame.
struct TransientRange {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::span<std::byte> bytes;
};

// Resources that the program no longer needs but the GPU may still use. They are destroyed when the last
// frame that used them has completed.
class RetiredResources {
  public:
    using Resource = std::variant<Buffer, Image, ImageView, Sampler, PipelineHandle, PipelineLayout,
                                  DescriptorPool, SwapchainHandle, Semaphore>;

    void add(Resource resource) { resources_.push_back(std::move(resource)); }
    void destroy() { resources_.clear(); }

  private:
    std::vector<Resource> resources_;
};

// One of the frames in flight, while it is recorded.
class FrameContext {
  public:
    [[nodiscard]] VkCommandBuffer commands() const { return commands_; }

    // Allocates transient memory for buffers; it is valid until this frame is begun again. The underlying
    // buffer grows on demand.
    Result<TransientRange> allocate(VkDeviceSize size);

    // Allocates a descriptor set, which is also valid until this frame is begun again.
    Result<VkDescriptorSet> descriptor_set(VkDescriptorSetLayout layout);

    // Destroys the resource when the GPU has completed this frame.
    void retire(RetiredResources::Resource resource) { retired_.add(std::move(resource)); }

    // Measure the GPU time of the commands recorded in between; pairs may be nested. They do nothing on GPUs
    // without timestamps, and after 64 timings in a frame.
    void begin_timing(std::string name);
    void end_timing();

  private:
    friend class Frames;
    Status prepare(Device& device);
    Status reset();
    Status add_descriptor_pool();
    void read_timings();

    Device* device_ = nullptr;
    CommandPool pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    Fence fence_;
    Buffer transient_buffer_;
    VkDeviceSize transient_used_ = 0;
    std::vector<DescriptorPool> descriptor_pools_;
    std::size_t descriptor_pool_ = 0;
    RetiredResources retired_;
    QueryPool queries_;
    std::vector<std::string> timing_names_;  // names, in the order of the queries
    std::vector<std::size_t> open_timings_;  // queries of timings that have begun and not ended; max_timings:
                                             // one that is not measured
    std::vector<PassTiming> timings_;        // of the previous use of this frame
};

class Frames {
  public:
    static Result<std::unique_ptr<Frames>> create(Device& device);

    // Waits until the GPU has completed the oldest frame in flight, and starts recording a new one.
    Result<FrameContext*> begin();

    struct Signals {
        std::span<const VkSemaphore>
            wait;  // the transfer commands of the frame wait for them, its drawing does not
        std::span<const VkSemaphore> signal;  // signalled when all commands are complete
    };
    // Ends recording and submits the frame.
    Status submit(FrameContext& frame, const Signals& signals);
    Status submit(FrameContext& frame) { return submit(frame, Signals{}); }

    // Waits until the GPU has completed all frames, destroys their retired resources and reads their timings.
    Status finish();

    // Timings of the last completed frame that has any, as of the last begin() or finish().
    [[nodiscard]] const std::vector<PassTiming>& timings() const { return timings_; }

  private:
    Device* device_ = nullptr;
    std::array<FrameContext, frames_in_flight> frames_;
    std::uint32_t next_ = 0;
    std::vector<PassTiming> timings_;
};

// Collects the resources of a descriptor set and writes them in one call.
class DescriptorWriter {
  public:
    // Allocates descriptor set `set` of the pipeline's layout. It lives as long as the frame.
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

    // Writes the set and returns it. Fails if a binding of the shaders was not set, or if a binding was set
    // that the shaders do not have.
    Result<VkDescriptorSet> finish();

  private:
    Device* device_ = nullptr;
    const Pipeline* pipeline_ = nullptr;
    std::uint32_t set_index_ = 0;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    // Deques, because the writes hold addresses of their elements.
    std::deque<VkDescriptorBufferInfo> buffers_;
    std::deque<std::vector<VkDescriptorImageInfo>> images_;
    std::vector<VkWriteDescriptorSet> writes_;
};

}  // namespace bolt::gpu
