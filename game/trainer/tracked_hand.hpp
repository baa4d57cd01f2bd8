// A hand whose pose a headset measures, by a controller or by its cameras. It reaches, closes on the wrench
// or on a nut, and opens; only the hand moves the tool. It feels no force, so a simulated arm stops the drawn
// hand where a real arm would stop it, and the controller vibrates.
#pragma once

#include <optional>
#include <string>

#include "engine/base/math.hpp"
#include "engine/xr/input.hpp"
#include "game/station/worn_glove.hpp"
#include "haptics/device/simulated_arm.hpp"

namespace bolt::trainer {

struct TrackedHand {
    xr::Side side = xr::Side::right;
    device::HandMotion motion;             // sent to the arm (device::tracked_hand_description)
    Pose fingertips;                       // of the open hand, in the assembly's frame
    std::optional<hand::Skeleton> joints;  // of the hand, in the assembly's frame; none: not measured
    bool present = false;                  // the headset tracks the hand
    bool had_wrench = false;               // in the previous frame
};

struct TrackedHandInput {
    const xr::HandInput& hand;
    Pose room_in_assembly;  // the room's frame in the assembly's
    bool wrench = false;    // the hand holds the wrench
    bool engaged = false;   // the tool holds a nut
};

// The closure of the hand, 0 (open) … 1, from a button of the controller or from the fingers.
double closed_share(const xr::HandInput& hand);

// The pose of the palm in the room; none: not tracked. It is the controller's grip pose, or made from the
// palm joint of XR_EXT_hand_tracking. Its axes are those of OpenXR's grip pose: X out of a left palm and into
// a right one, Y from the fingertips to the wrist, −Z to the thumb.
std::optional<Pose> palm_of(const xr::HandInput& hand, xr::Side side);

// The pose of the fingertips in the frame of the palm (palm_of). Its axes are those of the tool of a hand
// without a wrench: z points back along the fingers, as the palm's Y does.
Pose fingertips_at_palm(xr::Side side);

// The pose of the joint hand::palm in the frame of the fingertips.
Pose palm_joint_at_fingertips(xr::Side side);

// The devices that may be fixed to a gloved hand, and the registered poses of the wrist in the frames of
// their grip poses; none: not registered.
struct WristMount {
    std::optional<TrackerRole> tracker;  // role of the Vive tracker that the station file names
    std::optional<Pose> wrist_in_tracker, wrist_in_controller;
};

// The hand of `hands` with the fingers of a glove instead of those that the headset sees. It closes as the
// glove does; the buttons of a controller that is fixed to it do nothing, and it does not point. The first of
// these that applies determines the wrist:
//
//   1 the registered Vive tracker. While it is lost, the hand is not tracked, because a controller or a hand
//     that the cameras see may be another one
//   2 the registered controller
//   3 the headset's cameras
//   4 a controller that the hand holds
xr::HandInput with_glove(const xr::Hands& hands, const station_setup::WornFingers& fingers,
                         const WristMount& mount);

// The message to the user if the Vive tracker that the station file names does not measure the wrist;
// otherwise empty.
std::string wrist_fault(const xr::ViveTrackers& trackers, const WristMount& mount);

// Call once a frame. A hand that is not tracked keeps its pose and opens.
void track_hand(TrackedHand& tracked, const TrackedHandInput& input);

}  // namespace bolt::trainer
