#include "engine/gpu/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
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

struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::uint32_t type = 0;
    Memory::Tiling tiling = Memory::Tiling::linear;
    VkDeviceSize size = 0;
    std::byte* mapped = nullptr;
    FreeList free{0};
};

namespace {

constexpr VkDeviceSize usual_block = VkDeviceSize{64} << 20;

struct Wish {
    VkMemoryPropertyFlags needed, liked, disliked;
};

Wish wish(MemoryUse use) {
    constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    constexpr VkMemoryPropertyFlags visible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    switch (use) {
        case MemoryUse::device:
            return {local, 0, visible};  // host-visible video memory is scarce
        case MemoryUse::upload:
            return {visible, local, cached};
        case MemoryUse::readback:
            break;
    }
    return {visible, cached, local};
}

int count(VkMemoryPropertyFlags flags) {
    int n = 0;
    for (; flags != 0; flags &= flags - 1) ++n;
    return n;
}

}  // namespace

std::optional<std::uint32_t> memory_type(const VkPhysicalDeviceMemoryProperties& properties,
                                         std::uint32_t allowed_bits, MemoryUse use) {
    // Protected and lazily allocated memory serve other purposes; AMD's uncached device memory is slow.
    constexpr VkMemoryPropertyFlags never = VK_MEMORY_PROPERTY_PROTECTED_BIT |
                                            VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
                                            VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD;
    const Wish w = wish(use);
    std::optional<std::uint32_t> best;
    int best_score = 0;
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
        const VkMemoryPropertyFlags flags = properties.memoryTypes[i].propertyFlags;
        if ((allowed_bits >> i & 1U) == 0 || (flags & w.needed) != w.needed || (flags & never) != 0) continue;
        const int score = 4 * count(flags & w.liked) - count(flags & w.disliked);
        if (!best || score > best_score) {
            best = i;
            best_score = score;
        }
    }
    // If only host memory can hold the buffer, use it: slow is better than no buffer.
    if (!best && use == MemoryUse::device) return memory_type(properties, allowed_bits, MemoryUse::upload);
    return best;
}

Memory::Memory(VkPhysicalDevice physical, VkDevice device) : device_(device) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
}

Memory::~Memory() {
    for (const std::unique_ptr<Block>& block : blocks_) vkFreeMemory(device_, block->memory, nullptr);
}

Result<Block*> Memory::add_block(std::uint32_t type, VkDeviceSize size, Tiling tiling, bool mapped) {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = size;
    info.memoryTypeIndex = type;
    auto block = std::make_unique<Block>();
    block->type = type;
    block->tiling = tiling;
    block->size = size;
    block->free = FreeList(size);
    const auto what = [&] {
        return fmt::format("allocating {} MiB of GPU memory", (size + (1U << 20) - 1) >> 20);
    };
    BOLT_TRY(check(vkAllocateMemory(device_, &info, nullptr, &block->memory), what()));
    if (mapped) {
        void* address = nullptr;
        const VkResult result = vkMapMemory(device_, block->memory, 0, VK_WHOLE_SIZE, 0, &address);
        if (Status made = check(result, "mapping GPU memory"); !made) {
            vkFreeMemory(device_, block->memory, nullptr);
            return fail(made.error());
        }
        block->mapped = static_cast<std::byte*>(address);
    }
    blocks_.push_back(std::move(block));
    return blocks_.back().get();
}

Result<Allocation> Memory::allocate(const VkMemoryRequirements& needs, MemoryUse use, Tiling tiling) {
    const std::optional<std::uint32_t> type = memory_type(properties_, needs.memoryTypeBits, use);
    if (!type) return fail(ErrorCode::failed, "the GPU has no suitable memory type for a resource");
    const VkMemoryType& kind = properties_.memoryTypes[*type];
    const bool visible = (kind.propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    const VkDeviceSize block_size = std::min(usual_block, properties_.memoryHeaps[kind.heapIndex].size / 8);

    Block* home = nullptr;
    std::optional<std::uint64_t> offset;
    if (needs.size <= block_size / 2) {
        for (const std::unique_ptr<Block>& block : blocks_) {
            if (block->type != *type || block->tiling != tiling) continue;
            if ((offset = block->free.take(needs.size, needs.alignment))) {
                home = block.get();
                break;
            }
        }
    }
    if (home == nullptr) {
        const VkDeviceSize size = needs.size <= block_size / 2 ? block_size : needs.size;
        BOLT_TRY_ASSIGN(auto added, add_block(*type, size, tiling, visible));
        home = added;
        offset = home->free.take(needs.size, needs.alignment);
    }
    in_use_ += needs.size;
    std::byte* mapped =
        home->mapped != nullptr && use != MemoryUse::device ? home->mapped + *offset : nullptr;
    return Allocation{home->memory, *offset, needs.size, mapped, home};
}

void Memory::free(Allocation& allocation) {
    if (allocation.block == nullptr) return;
    Block* block = allocation.block;
    block->free.give_back(allocation.offset, allocation.size);
    in_use_ -= allocation.size;
    allocation = {};
    // Keep one empty shared block, to avoid alternating allocation and release; dedicated blocks are released
    // at once.
    const auto spare = [&](const std::unique_ptr<Block>& other) {
        return other.get() != block && other->type == block->type && other->tiling == block->tiling &&
               other->free.untouched();
    };
    const bool own = block->size > usual_block;
    if (!block->free.untouched() || (!own && std::none_of(blocks_.begin(), blocks_.end(), spare))) return;
    vkFreeMemory(device_, block->memory, nullptr);
    std::erase_if(blocks_, [&](const std::unique_ptr<Block>& other) { return other.get() == block; });
}

}  // namespace bolt::gpu
