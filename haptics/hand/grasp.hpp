// Decides whether the gloved hand holds the tool: grasped when thumb and fingers close on it, released when
// the thumb or all fingers have been away from it for a while. A held tool stays held while the glove is
// lost. Pure. An update with a fresh sample of the glove, or with an empty hand that has moved, costs
// one close_fingers(), so run it at the rate of the glove or of the pictures, not in the servo tick.
#pragma once

#include "haptics/hand/finger_closure.hpp"

namespace bolt::hand {

struct GraspOptions {
    std::size_t fingers = 2;          // number that must touch, opposed by the thumb, for a grasp
    double grasp_delay = 0.03;        // s of contact before the grasp
    double release_distance = 6e-3;   // m: released if the thumb or all fingers are farther away
    double release_delay = 0.15;      // s beyond release_distance before the release
    double silence = 0.1;             // s without a frame until the glove counts as lost
    double release_block_time = 0.5;  // s after the glove is back during which the tool is not released
};

struct GraspInput {
    bool fresh = false;     // a sample of the glove was received since the last update
    hand::Angles measured;  // of the latest sample
    Pose wrist;             // in the tool frame, while the tool is not held
};

// Reported once each.
enum class GraspEvent : std::uint8_t { none, grasped, released, glove_lost, glove_back };
// Text for the trainee; empty for `none`. The texts of glove_lost and glove_back depend on `held`: the tool
// is held.
const char* message_for(GraspEvent event, bool held);

struct GraspState {
    bool held = false;
    bool lost = false;      // the glove is lost
    Pose wrist;             // in the tool frame; while held the pose at the grasp
    hand::Angles measured;  // of the latest frame
    FingerClosure closure;  // the displayed posture
    bool grasping = false;  // the condition for a grasp holds

    bool has_frame = false;            // at least one frame was received
    double frame_age = 0.0;            // s since the latest frame
    bool change_pending = false;       // the condition for a grasp or release contradicts `held`
    double change_pending_for = 0.0;   // s of that contradiction
    double release_blocked_for = 0.0;  // s left of release_block_time
};

// Updates the grasp by `dt` s. Returns what changed. Call it also without a fresh frame, so that a lost glove
// is detected.
GraspEvent update_grasp(GraspState& grasp, const GraspOptions& options, const collision::ToolShape& tool,
                        const hand::Hand& hand, const GraspInput& input, double dt);

}  // namespace bolt::hand
