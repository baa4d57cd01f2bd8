#include "game/trainer/room_placement.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::trainer {

namespace {

// Design choices. Seated eyes are 1.1 m above the floor or higher (5th percentile of women, DIN 33402-2); on
// a low stool or in a wheelchair they may be a little lower.
constexpr double lowest_head = 0.9;     // m
constexpr double patience = 3.0;        // s
constexpr double longest_frame = 0.25;  // s; a slower frame counts as one of these
constexpr double facing_angle = to_radians(75.0), reachable = 2.5;  // rad, m

// True if the head is turned towards a point that is near enough to be used. A user who bends over the
// workpiece faces all that is above or below.
bool faces(const Pose& head, const Vec3& point) {
    const Vec3 right = head.orientation * Vec3(1.0, 0.0, 0.0);
    const glm::dvec2 ahead(right.z, -right.x), to(point.x - head.position.x, point.z - head.position.z);
    const double distance = glm::length(to);
    if (distance > reachable) return false;
    return distance < 0.1 || glm::length(ahead) < 1e-3 ||
           glm::dot(ahead, to) >= std::cos(facing_angle) * glm::length(ahead) * distance;
}

bool faces_panel(const Pose& head, const Pose& panel) {
    return (inverse(panel) * head.position).z > 0.0 && faces(head, panel.position);
}

}  // namespace

bool is_worn(const view::ImmersiveFrame& immersive) {
    return immersive.tracked && immersive.attentive &&
           (!immersive.floor_known || immersive.head.position.y >= lowest_head);
}

bool can_place(const Placement& placement, const view::ImmersiveFrame& immersive) {
    return immersive.expected_head || is_worn(immersive) ||
           (immersive.tracked && immersive.attentive && placement.waited >= patience);
}

ObjectsToPlace update(Placement& placement, const view::ImmersiveFrame& immersive,
                      const PlacedObjects& placed, double seconds) {
    const double passed = std::min(seconds, longest_frame);
    const bool worn = is_worn(immersive);
    if (immersive.expected_head) {
        placement.requested = false;
        return {};
    }
    if (immersive.recentred || placement.requested || (placement.provisional && worn)) {
        placement = {};
        return {true, true};
    }
    if (!placed.panel) {
        if (immersive.tracked && immersive.attentive) placement.waited += passed;
        return {};
    }
    placement.waited = 0.0;
    if (!worn) return {};
    placement.unseen = faces_panel(immersive.head, *placed.panel) ? 0.0 : placement.unseen + passed;
    if (placed.workpiece && faces(immersive.head, *placed.workpiece)) placement.workpiece_faced = true;
    if (placement.unseen < patience) return {};
    placement.unseen = 0.0;
    return {true, !placement.workpiece_faced};
}

}  // namespace bolt::trainer
