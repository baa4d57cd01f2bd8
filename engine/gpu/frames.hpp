// Frames in flight: while the GPU draws one, the CPU records the next. Each has its commands, its fence,
// memory for what changes every frame, descriptor sets, time stamps and what it retired.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "engine/gpu/retired.hpp"

namespace bolt::gpu {

inline constexpr std::uint32_t frames_in_flight = 2;

// How long a pass of a frame took on the GPU.
struct Timing {
    std::string name;
    double milliseconds = 0.0;
};

// A piece of a frame's buffer: written now, read by the GPU in this frame.
struct Piece {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    std::span<std::byte> bytes;
};

class Frame {
  public:
    [[nodiscard]] VkCommandBuffer commands() const { return commands_; }

    // Memory that lives until this frame comes again; for uniform and storage buffers. Grows when it is too
    // small.
    Result<Piece> piece(VkDeviceSize size);

    // A descriptor set that lives as long.
    Result<VkDescriptorSet> descriptor_set(VkDescriptorSetLayout layout);

    void retire(Retired::Thing thing) { retired_.add(std::move(thing)); }

    // Time stamps around what is recorded between; nothing on GPUs that have no clock.
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
    Buffer ring_;
    VkDeviceSize ring_used_ = 0;
    std::vector<DescriptorPool> descriptor_pools_;
    std::size_t descriptor_pool_ = 0;
    Retired retired_;
    QueryPool queries_;
    std::vector<std::string> timed_;  // names, in the order of the queries
    std::vector<std::size_t> open_;   // timings that have begun and not ended
    std::vector<Timing> timings_;     // of the time before
};

class Frames {
  public:
    static Result<std::unique_ptr<Frames>> create(Device& device);

    // Waits until the slot is free again, and starts recording.
    Result<Frame*> begin();

    // Ends recording and hands the frame to the GPU.
    struct Signals {
        VkSemaphore wait = VK_NULL_HANDLE;    // before anything is copied
        VkSemaphore signal = VK_NULL_HANDLE;  // when all is done
    };
    Status submit(Frame& frame, const Signals& signals);
    Status submit(Frame& frame) { return submit(frame, Signals{}); }

    // Waits until the GPU is done with all of them; what they retired goes, their timings can be read.
    Status finish();

    // Of the last frame that came back.
    [[nodiscard]] const std::vector<Timing>& timings() const { return timings_; }

  private:
    Device* device_ = nullptr;
    std::array<Frame, frames_in_flight> frames_;
    std::uint32_t next_ = 0;
    std::vector<Timing> timings_;
};

}  // namespace bolt::gpu
