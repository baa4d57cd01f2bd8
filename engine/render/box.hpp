// Axis-aligned bounding boxes.
#pragma once

#include <glm/common.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace bolt::render {

struct BoundingBox {
    glm::vec3 low{1e30F}, high{-1e30F};

    void add(const glm::vec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
};

// Returns the axis-aligned bounding box of a transformed box.
BoundingBox transformed(const BoundingBox& box, const glm::mat4& transform);

}  // namespace bolt::render
