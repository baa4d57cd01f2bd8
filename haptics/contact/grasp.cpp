#include "haptics/contact/grasp.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

// Whether a finger at one contact can push straight towards the other.
bool pushes_at(const FingertipContact& one, const FingertipContact& other) {
    const Vec3 between = other.point - one.point;
    return glm::dot(between, -one.normal) >= std::cos(friction_angle) * glm::length(between);
}

}  // namespace

Grasp grasp(const ToolShape& tool, const Fingertips& tips) {
    Grasp made;
    for (std::size_t i = 0; i < fingers; ++i) {
        FingertipContact& tip = made.tips[i];
        std::array<Side, 1> side;
        const double far =
            std::abs(near_point(tool.solid, tips.at[i], sight + tips.radius, 0.0, {}).distance);
        if (far > sight + tips.radius) continue;
        // A little further than it is, for the closest side to be among those within.
        if (near_point(tool.solid, tips.at[i], far + 1e-6, far + 1e-6, side).sides == 0) continue;
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

}  // namespace bolt::contact
