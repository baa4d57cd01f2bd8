#include "engine/xr/hand_gestures.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace bolt::xr {

namespace {

constexpr std::size_t thumb_tip = 5, index_knuckle = 7, index_tip = 10;  // of XR_EXT_hand_tracking
// The right shoulder of an adult, m, in the frame of a head that looks straight ahead.
constexpr double shoulder_right = 0.18, shoulder_down = 0.25, shoulder_back = 0.08;

// The rotation about the vertical of a head that may look up or down.
Quat heading(const Pose& head) {
    const Vec3 right = head.orientation * Vec3(1.0, 0.0, 0.0);
    return glm::angleAxis(std::atan2(-right.z, right.x), Vec3(0.0, 1.0, 0.0));
}

// The orientation whose −z is `along`, without tilt to a side.
Quat looking_along(const Vec3& along) {
    const double yaw = std::atan2(-along.x, -along.z),
                 pitch = std::atan2(along.y, std::hypot(along.x, along.z));
    return glm::angleAxis(yaw, Vec3(0.0, 1.0, 0.0)) * glm::angleAxis(pitch, Vec3(1.0, 0.0, 0.0));
}

}  // namespace

void add_gestures(HandInput& hand, Side side, const Pose& head, PinchState& pinch) {
    if (!hand.active || !hand.joints || hand.aim) {
        pinch = {};
        return;
    }
    const HandJoint &thumb = (*hand.joints)[thumb_tip], &index = (*hand.joints)[index_tip],
                    &knuckle = (*hand.joints)[index_knuckle];
    // A tip that is hidden for a moment neither begins nor ends a pinch.
    if (thumb.valid && index.valid)
        pinch.closed = glm::distance(thumb.pose.position, index.pose.position) <
                       (pinch.closed ? pinch_ends : pinch_begins);
    hand.select = pinch.closed ? 1.0F : 0.0F;
    if (!knuckle.valid) return;
    const Vec3 at_head(side == Side::right ? shoulder_right : -shoulder_right, -shoulder_down, shoulder_back);
    const Vec3 shoulder = head.position + heading(head) * at_head;
    const Vec3& from = knuckle.pose.position;
    if (glm::distance(from, shoulder) > 1e-3)
        hand.aim = ReportedPose{{from, looking_along(from - shoulder)}, true};
}

}  // namespace bolt::xr
