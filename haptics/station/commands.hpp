// What a station receives from the application besides its devices' samples. StationControls are states: only
// the latest value counts. StationCommands are events: each is executed once, in order, and none is lost.
#pragma once

#include <limits>
#include <optional>
#include <variant>

#include "engine/base/pose.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::station {

struct StationControls {
    servo::Grip grip = servo::Grip::none;  // `wrench` has no effect if a gloved hand determines the grip
    bool dead_man = false;                 // held, in addition to the devices' buttons
    // s after which `dead_man` expires unless the controls are sent again, so that a window that hangs
    // releases it.
    double dead_man_timeout = std::numeric_limits<double>::infinity();
    bool clutch = false, stop = false, reset = false;
    std::int16_t guide = -1;     // joint that the guiding force leads to; −1: none
    float click_setting = 0.0F;  // N·m, of a click-type torque wrench
    Quat view{1.0, 0.0, 0.0,
              0.0};  // unit, from the viewer's frame to the assembly's; a puck moves the tool in the former
    bool pause = false;  // no servo tick and no force; the tool stands still while the hand may move
    // Where the wrench lies while no hand holds it, in the assembly's frame; none: it moves with the open
    // hand.
    std::optional<Pose> wrench_rest{};
    // Wrist of a gloved hand without a wrench in the frame of its fingertips, which the device then moves;
    // none: the device moves the hand as if it held the tool.
    std::optional<Pose> bare_wrist{};
    // Joint to whose nut a tool moves by itself if its device gives rates and renders no force; −1: none.
    std::int16_t glide = -1;
};

// Moves the tool to a pose in the assembly's frame; the hand stays where it is, and the tool follows it from
// there.
struct PlaceTool {
    Pose tool{};
};
// Stores the state of the nuts for undo. Checkpoints are saved one a tick, before a pending restore.
struct SaveCheckpoint {};
// Restores the n-th last checkpoint, 1 … servo::max_checkpoints. It stays pending until the servo permits it
// (see servo::Input::undo), and replaces a pending restore. More steps than servo::max_checkpoints have no
// effect.
struct RestoreCheckpoint {
    std::uint8_t steps = 1;
};
// Changes a pending restore, or cancels it with `steps` 0. No effect if none is pending, so that a restore
// which completed in the meantime is not repeated.
struct AmendRestore {
    std::uint8_t steps = 0;
};

using StationCommand = std::variant<PlaceTool, SaveCheckpoint, RestoreCheckpoint, AmendRestore>;

// Commands that fit into a station's queue. The servo thread empties it every tick, in a pause too, so it
// fills only if that thread does not run. Station::send then fails.
inline constexpr std::size_t command_queue_capacity = 64;

}  // namespace bolt::station
