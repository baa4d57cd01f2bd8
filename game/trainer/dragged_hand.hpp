// A hand that the mouse moves freely, for a simulated arm. Drags, the mouse wheel and keys move the intended
// pose of the hand; the forces of the arm determine how closely the hand follows it. In the air a drag moves
// the hand in the plane of the picture and the mouse wheel moves it along the view; with the right button or
// Shift held too, a drag turns the tool about its own normal. Beside a bolt a drag moves the wrench across
// the bolt and the mouse wheel along it. On a bolt a drag swings the handle, and the mouse wheel moves the
// wrench along the bolt.
#pragma once

#include <optional>

#include "game/trainer/controls.hpp"
#include "game/trainer/pointing.hpp"
#include "haptics/device/simulated_arm.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/force/device_mapping.hpp"

namespace bolt::trainer {

struct DraggedHand {
    device::HandMotion motion;  // sent to the arm
    bool grasps = false;       // the left button was pressed on the wrench or the nut that the hand is beside
    bool button_down = false;  // the left button, in the last frame
    double scroll = 0.0;       // notches of the mouse wheel that the hand has still to follow
    double easing = 0.0;       // s until the hand opens; until then it lets the wrench on the nut spring back
};

// The view, the tool and the nut beside it, in the assembly's frame.
struct DragScene {
    Projection projection;
    Pose tool;            // as it is drawn
    bool wrench = false;  // the hand holds the wrench
    // The pointer is on the wrench or the nut that the hand is beside. A press elsewhere moves the open hand,
    // so that it can leave them.
    bool points_at_reachable = false;
    std::optional<force::Pivot> nut;           // that the hand holds or is beside
    bool engaged = false;                      // the hand holds the nut
    double handle_length = 0.0;                // m
    Quat arm_to_assembly{1.0, 0.0, 0.0, 0.0};  // unit, rotation from the arm's frame to the assembly's
    double scale = 1.0;                        // m of the tool per m of the arm
};

struct DragInput {
    FrameInput mouse;
    device::PuckInput keys;  // in the arm's frame
    bool turns = false;      // Shift is held: a drag turns the tool
    double seconds = 0.0;    // of the frame
};

// Call once a frame.
void drag_hand(DraggedHand& hand, const DragInput& input, const DragScene& scene);

}  // namespace bolt::trainer
