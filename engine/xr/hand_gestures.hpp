// The pointing ray and the pinch of a tracked hand, for runtimes that report only its joints
// (XR_EXT_hand_tracking without XR_EXT_hand_interaction).
#pragma once

#include "engine/xr/input.hpp"

namespace bolt::xr {

// Distances, m, between the tip joints of thumb and index finger at which a pinch begins and ends. When the
// skin touches, these joints are about 15 mm apart.
inline constexpr double pinch_begins = 0.022, pinch_ends = 0.04;

struct PinchState {
    bool closed = false;
};

// Sets `aim` and `select` of a hand that has joints and no aim pose; call it once a frame. The ray begins at
// the knuckle of the index finger, which a pinch hardly moves, and points away from the estimated shoulder.
// The long distance between shoulder and knuckle steadies the ray; the direction of a finger would change
// with every pinch. `head`: in the frame of the joints.
void add_gestures(HandInput& hand, Side side, const Pose& head, PinchState& pinch);

}  // namespace bolt::xr
