#include "engine/gpu/free_list.hpp"

#include <cassert>
#include <iterator>

namespace bolt::gpu {

std::optional<std::uint64_t> FreeList::take(std::uint64_t size, std::uint64_t alignment) {
    auto best = holes_.end();
    for (auto hole = holes_.begin(); hole != holes_.end(); ++hole) {
        const std::uint64_t start = (hole->first + alignment - 1) & ~(alignment - 1);
        const std::uint64_t lost = start - hole->first;
        if (hole->second < lost || hole->second - lost < size) continue;
        if (best == holes_.end() || hole->second < best->second) best = hole;
    }
    if (best == holes_.end()) return std::nullopt;
    const auto [offset, available] = *best;
    const std::uint64_t start = (offset + alignment - 1) & ~(alignment - 1);
    const std::uint64_t after = offset + available - (start + size);
    holes_.erase(best);
    if (start > offset) holes_[offset] = start - offset;
    if (after > 0) holes_[start + size] = after;
    return start;
}

void FreeList::give_back(std::uint64_t offset, std::uint64_t size) {
    auto next = holes_.lower_bound(offset);
    assert(next == holes_.end() || offset + size <= next->first);
    if (next != holes_.end() && offset + size == next->first) {
        size += next->second;
        next = holes_.erase(next);
    }
    if (next != holes_.begin()) {
        const auto before = std::prev(next);
        assert(before->first + before->second <= offset);
        if (before->first + before->second == offset) {
            before->second += size;
            return;
        }
    }
    holes_[offset] = size;
}

std::uint64_t FreeList::free_bytes() const {
    std::uint64_t sum = 0;
    for (const auto& [offset, size] : holes_) sum += size;
    return sum;
}

}  // namespace bolt::gpu
