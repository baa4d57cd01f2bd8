// The free ranges of a memory block. Best fit: allocates from the smallest range that is large enough, the
// lowest address first; freed ranges are merged with their neighbours. Independent of Vulkan.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace bolt::gpu {

class FreeList {
  public:
    explicit FreeList(std::uint64_t size) : size_(size) { holes_[0] = size; }

    // Returns the offset of a range of `size` > 0 bytes aligned to `alignment` (a power of two), or nullopt
    // if no free range is large enough.
    std::optional<std::uint64_t> take(std::uint64_t size, std::uint64_t alignment);

    // Frees a range that take() returned, with the same size.
    void give_back(std::uint64_t offset, std::uint64_t size);

    [[nodiscard]] bool untouched() const { return holes_.size() == 1 && holes_.begin()->second == size_; }
    [[nodiscard]] std::uint64_t free_bytes() const;

  private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> holes_;  // offset → size; no two are adjacent
};

}  // namespace bolt::gpu
