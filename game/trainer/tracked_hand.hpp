// A hand whose pose a headset measures, by a controller or by its cameras. It reaches, closes on the wrench
// or on a nut, and opens; only the hand moves the tool. It feels no force, so a simulated arm stops the drawn
// hand where a real arm would stop it, and the controller vibrates.
#pragma once

#include <optional>

#include "engine/base/math.hpp"
#include "engine/xr/input.hpp"
#include "haptics/device/simulated_arm.hpp"

namespace bolt::trainer {

struct TrackedHand {
    xr::Side side = xr::Side::right;
    device::HandMotion motion;  // sent to the arm (device::tracked_hand_description)
    Pose fingertips;            // of the open hand, in the assembly's frame
    bool present = false;       // the headset tracks the hand
    bool had_wrench = false;    // in the previous frame
};

struct TrackedHandInput {
    const xr::HandInput& hand;
    Pose room_in_assembly;  // the room's frame in the assembly's
    bool wrench = false;    // the hand holds the wrench
    bool engaged = false;   // the tool holds a nut
};

// The closure of the hand, 0 … 1, from a button of the controller or from the fingers.
double closure(const xr::HandInput& hand);

// The pose of the palm in the room; none: not tracked. It is the controller's grip pose, or made from the
// palm joint of XR_EXT_hand_tracking. Its axes are those of OpenXR's grip pose: X out of a left palm and into
// a right one, Y from the fingertips to the wrist, −Z to the thumb.
std::optional<Pose> palm_of(const xr::HandInput& hand, xr::Side side);

// The pose of the fingertips in the frame of the palm (palm_of). Its axes are those of the tool of a hand
// without a wrench: z points back along the fingers, as the palm's Y does.
Pose fingertips_at_palm(xr::Side side);

// The pose of the joint hand::palm in the frame of the fingertips.
Pose palm_joint_at_fingertips(xr::Side side);

// Call once a frame. A hand that is not tracked keeps its pose and opens.
void track_hand(TrackedHand& tracked, const TrackedHandInput& input);

}  // namespace bolt::trainer
