#include "engine/gpu/memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <iterator>

namespace bolt::gpu {

std::optional<std::uint64_t> FreeList::allocate(std::uint64_t size, std::uint64_t alignment) {
    auto best = free_ranges_.end();
    for (auto range = free_ranges_.begin(); range != free_ranges_.end(); ++range) {
        const std::uint64_t start = (range->first + alignment - 1) & ~(alignment - 1);
        const std::uint64_t padding = start - range->first;
        if (range->second < padding || range->second - padding < size) continue;
        if (best == free_ranges_.end() || range->second < best->second) best = range;
    }
    if (best == free_ranges_.end()) return std::nullopt;
    const auto [offset, available] = *best;
    const std::uint64_t start = (offset + alignment - 1) & ~(alignment - 1);
    const std::uint64_t after = offset + available - (start + size);
    free_ranges_.erase(best);
    if (start > offset) free_ranges_[offset] = start - offset;
    if (after > 0) free_ranges_[start + size] = after;
    return start;
}

void FreeList::free(std::uint64_t offset, std::uint64_t size) {
    auto next = free_ranges_.lower_bound(offset);
    assert(next == free_ranges_.end() || offset + size <= next->first);
    if (next != free_ranges_.end() && offset + size == next->first) {
        size += next->second;
        next = free_ranges_.erase(next);
    }
    if (next != free_ranges_.begin()) {
        const auto before = std::prev(next);
        assert(before->first + before->second <= offset);
        if (before->first + before->second == offset) {
            before->second += size;
            return;
        }
    }
    free_ranges_[offset] = size;
}

std::uint64_t FreeList::free_bytes() const {
    std::uint64_t sum = 0;
    for (const auto& [offset, size] : free_ranges_) sum += size;
    return sum;
}

struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    std::uint32_t type = 0;
    Memory::Tiling tiling = Memory::Tiling::linear;
    VkDeviceSize size = 0;
    bool dedicated = false;  // to one resource
    std::byte* mapped = nullptr;
    FreeList free_list{0};
};

namespace {

constexpr VkDeviceSize default_block_size = VkDeviceSize{64} << 20;

struct MemoryPreferences {
    VkMemoryPropertyFlags required, preferred, avoided;
};

MemoryPreferences preferences(MemoryUse use) {
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

int count_bits(VkMemoryPropertyFlags flags) {
    int n = 0;
    for (; flags != 0; flags &= flags - 1) ++n;
    return n;
}

}  // namespace

std::optional<std::uint32_t> memory_type(const VkPhysicalDeviceMemoryProperties& properties,
                                         std::uint32_t allowed_bits, MemoryUse use) {
    // Protected and lazily allocated memory serve other purposes; AMD's uncached device memory is slow.
    constexpr VkMemoryPropertyFlags unusable = VK_MEMORY_PROPERTY_PROTECTED_BIT |
                                               VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
                                               VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD;
    const MemoryPreferences p = preferences(use);
    std::optional<std::uint32_t> best;
    int best_score = 0;
    for (std::uint32_t i = 0; i < properties.memoryTypeCount; ++i) {
        const VkMemoryPropertyFlags flags = properties.memoryTypes[i].propertyFlags;
        if ((allowed_bits >> i & 1U) == 0 || (flags & p.required) != p.required || (flags & unusable) != 0)
            continue;
        const int score = 4 * count_bits(flags & p.preferred) - count_bits(flags & p.avoided);
        if (!best || score > best_score) {
            best = i;
            best_score = score;
        }
    }
    // If only host memory can hold the resource, use that: it is slow, but works.
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
    block->free_list = FreeList(size);
    const auto what = [&] {
        return fmt::format("allocating {} MiB of GPU memory", (size + (1U << 20) - 1) >> 20);
    };
    BOLT_TRY(check(vkAllocateMemory(device_, &info, nullptr, &block->memory), what()));
    if (mapped) {
        void* address = nullptr;
        const VkResult result = vkMapMemory(device_, block->memory, 0, VK_WHOLE_SIZE, 0, &address);
        if (Status created = check(result, "mapping GPU memory"); !created) {
            vkFreeMemory(device_, block->memory, nullptr);
            return fail(created.error());
        }
        block->mapped = static_cast<std::byte*>(address);
    }
    blocks_.push_back(std::move(block));
    return blocks_.back().get();
}

Result<Allocation> Memory::allocate(const VkMemoryRequirements& needs, MemoryUse use, Tiling tiling) {
    const std::optional<std::uint32_t> type = memory_type(properties_, needs.memoryTypeBits, use);
    if (!type)
        return fail(ErrorCode::failed, "the GPU has no suitable memory type for a resource",
                    "one with the required properties");
    const VkMemoryType& chosen = properties_.memoryTypes[*type];
    const bool visible = (chosen.propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    const VkDeviceSize block_size =
        std::min(default_block_size, properties_.memoryHeaps[chosen.heapIndex].size / 8);

    const bool dedicated = needs.size > block_size / 2;
    Block* target = nullptr;
    std::optional<std::uint64_t> offset;
    if (!dedicated) {
        for (const std::unique_ptr<Block>& block : blocks_) {
            if (block->dedicated || block->type != *type || block->tiling != tiling) continue;
            if ((offset = block->free_list.allocate(needs.size, needs.alignment))) {
                target = block.get();
                break;
            }
        }
    }
    if (target == nullptr) {
        BOLT_TRY_ASSIGN(target, add_block(*type, dedicated ? needs.size : block_size, tiling, visible));
        target->dedicated = dedicated;
        offset = target->free_list.allocate(needs.size, needs.alignment);
    }
    in_use_ += needs.size;
    std::byte* mapped =
        target->mapped != nullptr && use != MemoryUse::device ? target->mapped + *offset : nullptr;
    return Allocation{target->memory, *offset, needs.size, mapped, target};
}

void Memory::free(Allocation& allocation) {
    if (allocation.block == nullptr) return;
    Block* block = allocation.block;
    block->free_list.free(allocation.offset, allocation.size);
    in_use_ -= allocation.size;
    allocation = {};
    // Keep one empty shared block of each kind, so that a block is not allocated and released alternately.
    // Dedicated blocks are released at once.
    const auto is_spare = [&](const std::unique_ptr<Block>& other) {
        return other.get() != block && other->type == block->type && other->tiling == block->tiling &&
               other->free_list.all_free();
    };
    if (!block->free_list.all_free() ||
        (!block->dedicated && std::none_of(blocks_.begin(), blocks_.end(), is_spare)))
        return;
    vkFreeMemory(device_, block->memory, nullptr);
    std::erase_if(blocks_, [&](const std::unique_ptr<Block>& other) { return other.get() == block; });
}

}  // namespace bolt::gpu
