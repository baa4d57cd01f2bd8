#include "game/trainer/tracked_hand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace bolt::trainer {

namespace {

// m, HandMotion::max_deflection. In the air the hand's spring of 300 N/m then pulls with less than the 12 N
// of the arm, so that the hand cannot push through a wall; on a bolt a pull needs the arm's full force.
constexpr double open_deflection = 0.035, pull_deflection = 0.06;

// m from the palm to the point where thumb and index finger meet, in the frame of the grip pose of a right
// hand: X into the palm, Y from the fingertips to the wrist, −Z to the thumb. Typical of adults.
constexpr double pinch_out = 0.03, pinch_along = 0.08, pinch_thumb = 0.03;

// Distance of thumb tip and index fingertip at which tracked fingers count as open, and as closed, m.
constexpr double open_distance = 0.07, closed_distance = 0.02;
constexpr std::size_t palm_joint = 0, thumb_tip = 5, index_tip = 10;  // of XR_EXT_hand_tracking

// The rotation of the grip pose in the frame of the palm joint. The joint's −Z points along the fingers and
// its Y out of the back of the hand. The grip pose has the fingers along −Y, −Z to the thumb, and X to the
// right when both palms face each other.
Quat grip_at_palm_joint(xr::Side side) {
    const double out = side == xr::Side::right ? 1.0 : -1.0;
    return glm::quat_cast(glm::dmat3(Vec3(0.0, out, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(out, 0.0, 0.0)));
}

}  // namespace

double closed_share(const xr::HandInput& hand) {
    double by_fingers = 0.0;
    if (hand.joints) {
        const xr::HandJoint &thumb = (*hand.joints)[thumb_tip], &index = (*hand.joints)[index_tip];
        if (thumb.valid && index.valid)
            by_fingers = (open_distance - glm::distance(thumb.pose.position, index.pose.position)) /
                         (open_distance - closed_distance);
    }
    const auto by_button = static_cast<double>(std::max(hand.grasp, hand.select));
    return std::clamp(std::max(by_button, by_fingers), 0.0, 1.0);
}

std::optional<Pose> palm_of(const xr::HandInput& hand, xr::Side side) {
    if (!hand.active) return std::nullopt;
    if (hand.grip) return hand.grip->pose;
    if (!hand.joints || !(*hand.joints)[palm_joint].valid) return std::nullopt;
    const Pose& palm = (*hand.joints)[palm_joint].pose;
    return Pose{palm.position, glm::normalize(palm.orientation * grip_at_palm_joint(side))};
}

Pose fingertips_at_palm(xr::Side side) {
    const double out = side == xr::Side::right ? -pinch_out : pinch_out;
    // x along the grip's X, y along its −Z, z along its Y.
    return {{out, -pinch_along, -pinch_thumb}, glm::angleAxis(-0.5 * pi, Vec3(1.0, 0.0, 0.0))};
}

Pose palm_joint_at_fingertips(xr::Side side) {
    const Pose palm{Vec3(0.0), glm::conjugate(grip_at_palm_joint(side))};
    return inverse(fingertips_at_palm(side)) * palm;
}

xr::HandInput with_glove(const xr::Hands& hands, const station_setup::WornFingers& fingers,
                         const WristMount& mount) {
    const xr::HandInput& hand = hands[fingers.side];
    std::optional<Pose> wrist;
    if (mount.tracker && mount.wrist_in_tracker) {
        if (const std::optional<xr::ReportedPose>& tracker = hands.trackers[*mount.tracker])
            wrist = tracker->pose * *mount.wrist_in_tracker;
    } else if (hand.active && hand.grip && mount.wrist_in_controller)
        wrist = hand.grip->pose * *mount.wrist_in_controller;
    else if (hand.active && hand.joints && (*hand.joints)[hand::wrist].valid)
        wrist = (*hand.joints)[hand::wrist].pose;
    else if (const auto palm = palm_of(hand, fingers.side)) {
        const Pose palm_at_wrist{fingers.joints.position[hand::palm], fingers.joints.rotation[hand::palm]};
        wrist = *palm * Pose{Vec3(0.0), glm::conjugate(grip_at_palm_joint(fingers.side))} *
                inverse(palm_at_wrist);
    }
    xr::HandInput gloved;
    gloved.grasp = static_cast<float>(fingers.closed_share);
    gloved.active = wrist.has_value();
    if (!wrist) return gloved;
    xr::HandJoints& joints = gloved.joints.emplace();
    for (std::size_t i = 0; i < hand::joint_count; ++i)
        joints[i] = {*wrist * Pose{fingers.joints.position[i], fingers.joints.rotation[i]}, 0.0, true};
    return gloved;
}

std::string wrist_fault(const xr::ViveTrackers& trackers, const WristMount& mount) {
    if (!mount.tracker) return {};
    if (!mount.wrist_in_tracker)
        return fmt::format(
            "glove: the wrist is not registered with the Vive tracker {}; expected a "
            "registration by boltwright station register --hand SIDE --trainee NAME",
            name(*mount.tracker));
    const std::optional<Error> fault = xr::tracker_fault(trackers, *mount.tracker);
    return fault ? "glove: " + fault->message() : std::string();
}

namespace {

// The joints in the assembly's frame; none: not all are measured.
std::optional<hand::Skeleton> skeleton_of(const xr::HandInput& hand, const Pose& room_in_assembly) {
    if (!hand.joints) return std::nullopt;
    hand::Skeleton joints;
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        if (!(*hand.joints)[i].valid) return std::nullopt;
        const Pose joint = room_in_assembly * (*hand.joints)[i].pose;
        joints.position[i] = joint.position;
        joints.rotation[i] = joint.orientation;
    }
    return joints;
}

}  // namespace

void track_hand(TrackedHand& tracked, const TrackedHandInput& input) {
    const std::optional<Pose> palm = palm_of(input.hand, tracked.side);
    tracked.present = palm.has_value();
    tracked.motion.gripper = palm ? 1.0 - closed_share(input.hand) : 1.0;
    if (!palm) return;
    const Pose hand = input.room_in_assembly * *palm;
    tracked.joints = skeleton_of(input.hand, input.room_in_assembly);
    tracked.fingertips = hand * fingertips_at_palm(tracked.side);
    tracked.motion.target = tracked.fingertips;
    // The end of the wrench's handle is in the palm.
    if (input.wrench) tracked.motion.target->position = hand.position;
    tracked.motion.max_deflection = input.engaged ? pull_deflection : open_deflection;
}

}  // namespace bolt::trainer
