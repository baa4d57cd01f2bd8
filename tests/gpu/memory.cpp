#include "engine/gpu/memory.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/base/random.hpp"
#include "engine/gpu/resources.hpp"
#include "tests/gpu/support.hpp"

using namespace bolt;
using namespace bolt::gpu;

namespace {

constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags visible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

VkPhysicalDeviceMemoryProperties machine(std::initializer_list<VkMemoryPropertyFlags> types) {
    VkPhysicalDeviceMemoryProperties p{};
    for (const VkMemoryPropertyFlags flags : types) p.memoryTypes[p.memoryTypeCount++].propertyFlags = flags;
    return p;
}

}  // namespace

TEST_CASE(
    "Memory types: a discrete GPU uses video memory, its host-visible part for uploads, cached host memory "
    "for readback") {
    const auto p = machine({0, local, visible, visible | cached, local | visible});
    CHECK(memory_type(p, ~0U, MemoryUse::device) == 1U);
    CHECK(memory_type(p, ~0U, MemoryUse::upload) == 4U);
    CHECK(memory_type(p, ~0U, MemoryUse::readback) == 3U);
    // Without host-visible video memory, uploads go to host memory, uncached if possible.
    const auto q = machine({local, visible | cached, visible});
    CHECK(memory_type(q, ~0U, MemoryUse::upload) == 2U);
    CHECK(memory_type(q, 0b011U, MemoryUse::upload) == 1U);
}

TEST_CASE(
    "Memory types: lavapipe's only type serves every use; disallowed, protected or incoherent types are not "
    "chosen") {
    const auto one = machine({local | visible | cached});
    for (const MemoryUse use : {MemoryUse::device, MemoryUse::upload, MemoryUse::readback}) {
        CHECK(memory_type(one, ~0U, use) == 0U);
        CHECK_FALSE(memory_type(one, 0b10U, use).has_value());
    }
    const auto odd =
        machine({local | VK_MEMORY_PROPERTY_PROTECTED_BIT, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, visible});
    CHECK(memory_type(odd, ~0U, MemoryUse::device) == 2U);  // host memory is better than none
    CHECK(memory_type(odd, ~0U, MemoryUse::readback) == 2U);
}

TEST_CASE("FreeList: allocated ranges are aligned and never overlap, and freed ranges merge into one") {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed);
        constexpr std::uint64_t size = 1 << 20;
        FreeList list(size);
        struct Range {
            std::uint64_t offset, size;
        };
        std::vector<Range> taken;
        std::uint64_t used = 0;
        for (int step = 0; step < 2000; ++step) {
            if (random.chance(0.55)) {
                const std::uint64_t bytes = 1 + random.bits() % 20'000;
                const std::uint64_t alignment = std::uint64_t{1} << (random.bits() % 13);
                const auto offset = list.allocate(bytes, alignment);
                if (!offset) continue;
                REQUIRE(*offset % alignment == 0);
                REQUIRE(*offset + bytes <= size);
                for (const Range& other : taken)
                    REQUIRE((*offset + bytes <= other.offset || other.offset + other.size <= *offset));
                taken.push_back({*offset, bytes});
                used += bytes;
            } else if (!taken.empty()) {
                const std::size_t i = random.bits() % taken.size();
                list.free(taken[i].offset, taken[i].size);
                used -= taken[i].size;
                taken.erase(taken.begin() + static_cast<std::ptrdiff_t>(i));
            }
            REQUIRE(list.free_bytes() == size - used);
        }
        for (const Range& range : taken) list.free(range.offset, range.size);
        REQUIRE(list.all_free());
    }
}

TEST_CASE("FreeList: best fit takes the smallest range that is large enough") {
    FreeList list(1000);
    const auto a = list.allocate(300, 1), b = list.allocate(100, 1), c = list.allocate(50, 1);
    REQUIRE((a && b && c));
    list.free(*a, 300);
    list.free(*b, 100);
    CHECK(list.allocate(550, 1) == 450U);  // the end, not [0, 400)
    CHECK(list.allocate(400, 1) == 0U);    // freed neighbours are merged
    CHECK_FALSE(list.allocate(1, 1).has_value());
}

TEST_CASE(
    "Memory: small resources share blocks, buffers and images never share one, large ones are released") {
    test::Gpu gpu;
    Memory& memory = gpu.device().memory();
    const std::size_t before = memory.blocks();
    {
        std::vector<Buffer> buffers;
        for (int i = 0; i < 100; ++i)
            buffers.push_back(gpu.need(
                Buffer::create(gpu.device(), 10'000, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::device)));
        CHECK(memory.blocks() == before + 1);
        ImageInfo info;
        info.format = VK_FORMAT_R8G8B8A8_UNORM;
        info.extent = {64, 64};
        info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
        const Image image = gpu.need(Image::create(gpu.device(), info));
        CHECK(memory.blocks() == before + 2);
        const Buffer large = gpu.need(Buffer::create(gpu.device(), VkDeviceSize{100} << 20,
                                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::device));
        CHECK(memory.blocks() == before + 3);
        CHECK(memory.bytes_in_use() >= (VkDeviceSize{100} << 20) + 1'000'000);
    }
    CHECK(memory.blocks() == before + 2);  // one spare block of each kind is kept
    CHECK(memory.bytes_in_use() == 0);
}

TEST_CASE("Memory: a dedicated block that is smaller than a shared one is released at once") {
    test::Gpu gpu;
    Memory& memory = gpu.device().memory();
    const std::size_t before = memory.blocks();
    {
        const Buffer large = gpu.need(Buffer::create(gpu.device(), VkDeviceSize{40} << 20,
                                                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::device));
        CHECK(memory.blocks() == before + 1);
    }
    CHECK(memory.blocks() == before);
}
