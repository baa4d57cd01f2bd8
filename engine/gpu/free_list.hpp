// Ranges of a block that are free. Best fit: the smallest hole that holds the request, the lowest of equals;
// freed ranges join their neighbours. Knows nothing of Vulkan.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace bolt::gpu {

class FreeList {
  public:
    explicit FreeList(std::uint64_t size) : size_(size) { holes_[0] = size; }

    // The offset of a range of `size` > 0 bytes aligned to `alignment` (a power of two), or nothing if no
    // hole holds it.
    std::optional<std::uint64_t> take(std::uint64_t size, std::uint64_t alignment);

    // A range that take() gave, with the same size.
    void give_back(std::uint64_t offset, std::uint64_t size);

    [[nodiscard]] bool untouched() const { return holes_.size() == 1 && holes_.begin()->second == size_; }
    [[nodiscard]] std::uint64_t free_bytes() const;

  private:
    std::uint64_t size_;
    std::map<std::uint64_t, std::uint64_t> holes_;  // offset → size, none touching
};

}  // namespace bolt::gpu
