// A box along the axes, and a triangle that knows which part it belongs to.
#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/base/math.hpp"

namespace bolt::geometry {

struct Box {
    Vec3 low{std::numeric_limits<double>::infinity()};
    Vec3 high{-std::numeric_limits<double>::infinity()};

    void add(const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] Vec3 middle() const { return 0.5 * (low + high); }
    [[nodiscard]] Vec3 half() const { return 0.5 * (high - low); }
};

struct Triangle {
    Vec3 a, b, c;
    std::uint32_t part = 0;
};

inline Vec3 normal_of(const Triangle& t) { return glm::cross(t.b - t.a, t.c - t.a); }  // twice the area

}  // namespace bolt::geometry
