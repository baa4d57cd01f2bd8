// Device memory in blocks of 64 MiB (less on small heaps) that many resources share; large ones get memory of
// their own. Buffers and optimally tiled images never share a block, so bufferImageGranularity is always
// kept. What the CPU touches is mapped once, for good, and always coherent: there is nothing to flush.
//
// On a discrete GPU `device` is memory that the CPU cannot see, and getting data there takes an upload; on
// lavapipe and integrated GPUs everything is one kind, and mistakes here do not show. tests/gpu/memory.cpp
// holds the choice against both.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/gpu/free_list.hpp"
#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

enum class MemoryUse : std::uint8_t {
    device,  // the GPU's alone
    upload,  // written by the CPU, read by the GPU: straight into video memory where the CPU can see a little
             // of it
    readback,  // written by the GPU, read by the CPU: cached where there is such
};

// The memory type for a use among the allowed bits; nothing if none will do.
std::optional<std::uint32_t> memory_type(const VkPhysicalDeviceMemoryProperties& properties,
                                         std::uint32_t allowed_bits, MemoryUse use);

struct Block;

// A range of memory; given back through Memory::free.
struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;  // null for `device`
    Block* block = nullptr;
};

// Not for several threads at once.
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
