// A set of points with proximity tests, for the surface samples of a solid.
#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::collision {

// A grid of cubic cells with sides of 2 · `size` (m), in a hash table. All points within `size` of a point
// are in eight cells.
class PointGrid {
  public:
    explicit PointGrid(double size) : size_(size), slots_(64) {}

    void add(const Vec3& p) {
        if (2 * used_ >= slots_.size()) grow();
        Slot& slot = find(key(floor(p)));
        if (slot.last == none) {
            slot.key = key(floor(p));
            ++used_;
        }
        points_.push_back({p, slot.last});
        slot.last = static_cast<std::uint32_t>(points_.size() - 1);
    }
    [[nodiscard]] bool has_near(const Vec3& p) const {  // true if a point is within `size`
        const Vec3 at = p / (2.0 * size_);
        const Cell here = floor(p);
        Cell step{};  // to the neighbour on the nearer side
        for (int k = 0; k < 3; ++k)
            step[static_cast<std::size_t>(k)] =
                at[k] - static_cast<double>(here[static_cast<std::size_t>(k)]) < 0.5 ? -1 : 1;
        for (unsigned i = 0; i < 8; ++i) {
            const Cell cell{here[0] + (i & 1U ? step[0] : 0), here[1] + (i & 2U ? step[1] : 0),
                            here[2] + (i & 4U ? step[2] : 0)};
            for (std::uint32_t n = find(key(cell)).last; n != none; n = points_[n].previous)
                if (glm::dot(p - points_[n].at, p - points_[n].at) < size_ * size_) return true;
        }
        return false;
    }

  private:
    static constexpr std::uint32_t none = 0xffffffffU;
    using Cell = std::array<std::int64_t, 3>;
    struct Point {
        Vec3 at;
        std::uint32_t previous;  // in the same cell
    };
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t last = none;  // the cell's newest point; none: the slot is free
    };
    [[nodiscard]] Cell floor(const Vec3& p) const {
        const Vec3 at = glm::floor(p / (2.0 * size_));
        return {static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y),
                static_cast<std::int64_t>(at.z)};
    }
    // Cells 2^21 apart have the same key. The distance test distinguishes their points.
    static std::uint64_t key(const Cell& c) {
        constexpr std::uint64_t mask = (1U << 21U) - 1;
        return (static_cast<std::uint64_t>(c[0]) & mask) | (static_cast<std::uint64_t>(c[1]) & mask) << 21U |
               (static_cast<std::uint64_t>(c[2]) & mask) << 42U;
    }
    // The slot of a cell, or the free slot for it.
    [[nodiscard]] std::size_t index(std::uint64_t key) const {
        std::size_t i = static_cast<std::size_t>(key * 0x9e3779b97f4a7c15ULL >> 32U) & (slots_.size() - 1);
        while (slots_[i].last != none && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
        return i;
    }
    Slot& find(std::uint64_t key) { return slots_[index(key)]; }
    [[nodiscard]] const Slot& find(std::uint64_t key) const { return slots_[index(key)]; }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.last != none) find(slot.key) = slot;
    }

    double size_;
    std::size_t used_ = 0;
    std::vector<Slot> slots_;  // a power of two
    std::vector<Point> points_;
};

}  // namespace bolt::collision
