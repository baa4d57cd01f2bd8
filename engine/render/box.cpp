#include "engine/render/box.hpp"

namespace bolt::render {

BoundingBox transformed(const BoundingBox& box, const glm::mat4& transform) {
    BoundingBox moved;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 point((corner & 1) != 0 ? box.high.x : box.low.x,
                              (corner & 2) != 0 ? box.high.y : box.low.y,
                              (corner & 4) != 0 ? box.high.z : box.low.z);
        moved.add(glm::vec3(transform * glm::vec4(point, 1.0F)));
    }
    return moved;
}

}  // namespace bolt::render
