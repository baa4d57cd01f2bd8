// Allocates GPU memory.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// The free ranges of a memory block. Best fit: allocates from the smallest range that is large enough, and
// from the one with the lowest offset among equals. Freed ranges are merged with their neighbours.
// Independent of Vulkan.
class FreeList {
  public:
    explicit FreeList(std::uint64_t size) : size_(size) { free_ranges_[0] = size; }

    // Returns the offset of a range of `size` > 0 bytes aligned to `alignment` (a power of two), or nullopt
    // if no free range is large enough.
    std::optional<std::uint64_t> allocate(std::uint64_t size, std::uint64_t alignment);

    // Frees a range that allocate() returned, with the same size.
    void free(std::uint64_t offset, std::uint64_t size);

    [[nodiscard]] bool all_free() const {
        return free_ranges_.size() == 1 && free_ranges_.begin()->second == size_;
    }
    [[nodiscard]] std::uint64_t free_bytes() const;

  private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> free_ranges_;  // offset → size; no two are adjacent
};

// On a discrete GPU the CPU cannot access `device` memory; data is copied there from `upload` memory.
// Lavapipe and integrated GPUs have only one kind of memory and hide mistakes; tests/gpu/memory.cpp checks
// the choice of memory type for both.
enum class MemoryUse : std::uint8_t {
    device,    // accessed by the GPU only
    upload,    // written by the CPU, read by the GPU; host-visible video memory if the GPU has some
    readback,  // written by the GPU, read by the CPU; cached by the CPU if possible
};

// Returns the index of the most suitable memory type among those in `allowed_bits`; nullopt if none is
// suitable.
std::optional<std::uint32_t> memory_type(const VkPhysicalDeviceMemoryProperties& properties,
                                         std::uint32_t allowed_bits, MemoryUse use);

struct Block;

// A range of device memory; release it with Memory::free.
struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;  // null for MemoryUse::device
    Block* block = nullptr;
};

// Resources share blocks of 64 MiB (less on small heaps). Resources larger than half of that get a dedicated
// block, which is released with them. Buffers and optimally tiled images never share a block, so
// bufferImageGranularity is always respected. Host-visible memory is mapped once, permanently, and is always
// coherent: no flush is needed. Not thread-safe.
class Memory {
  public:
    Memory(VkPhysicalDevice physical, VkDevice device);
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    enum class Tiling : std::uint8_t { linear, optimal };
    Result<Allocation> allocate(const VkMemoryRequirements& needs, MemoryUse use, Tiling tiling);
    void free(Allocation& allocation);

    [[nodiscard]] std::size_t blocks() const { return blocks_.size(); }
    [[nodiscard]] VkDeviceSize bytes_in_use() const { return in_use_; }

  private:
    Result<Block*> add_block(std::uint32_t type, VkDeviceSize size, Tiling tiling, bool mapped);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::vector<std::unique_ptr<Block>> blocks_;
    VkDeviceSize in_use_ = 0;
};

}  // namespace bolt::gpu
