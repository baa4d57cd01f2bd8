#include "haptics/hand/fingertip_contact.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::hand {
namespace {

// True if the line to the other contact lies in the friction cone of this one.
bool pushes_at(const FingertipContact& one, const FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(friction_angle) * glm::length(between);
}

}  // namespace

FingertipGrasp fingertip_grasp(const collision::ToolShape& tool, const Fingertips& tips) {
    FingertipGrasp made;
    for (std::size_t i = 0; i < fingers; ++i) {
        FingertipContact& tip = made.tips[i];
        std::array<collision::SeparatingPlane, 1> side;
        const double far =
            std::abs(collision::query_point(tool.solid, tips.at[i], sight + tips.radius, 0.0, {}).distance);
        if (far > sight + tips.radius) continue;
        // A margin, so that the closest side is among the candidates.
        if (collision::query_point(tool.solid, tips.at[i], far + 1e-6, far + 1e-6, side).planes == 0)
            continue;
        tip = {side[0].distance - tips.radius, side[0].point, side[0].normal};
    }
    const FingertipContact& thumb = made.tips[0];
    for (std::size_t i = 1; i < fingers; ++i) {
        const FingertipContact& finger = made.tips[i];
        made.held = made.held || (thumb.distance <= touching && finger.distance <= touching &&
                                  pushes_at(thumb, finger) && pushes_at(finger, thumb));
    }
    return made;
}

}  // namespace bolt::hand
