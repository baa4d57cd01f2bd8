// Input and output of a servo tick: small plain values. The session file records the input exactly and most
// of the output in single precision (game/session/recorded_tick.hpp).
#pragma once

#include <cstdint>

#include "engine/base/math.hpp"
#include "haptics/collision/contact.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::servo {

enum class Grip : std::uint8_t { none, fingers, wrench };

// The pose that the hand commands for the tool, in the assembly's frame. Single precision, which exceeds the
// resolution of devices, so that the recorded pose equals the pose that the tick used. Tool frame: origin at
// the centre of the jaw (or between the fingertips), x along the handle, z normal to the jaw.
struct CommandedTool {
    float position[3] = {0.0F, 0.0F, 0.0F};           // m
    float orientation[4] = {1.0F, 0.0F, 0.0F, 0.0F};  // unit quaternion w, x, y, z: tool to assembly
};

inline CommandedTool to_commanded_tool(const Pose& tool) {
    CommandedTool commanded;
    for (int i = 0; i < 3; ++i) commanded.position[i] = static_cast<float>(tool.position[i]);
    commanded.orientation[0] = static_cast<float>(tool.orientation.w);
    commanded.orientation[1] = static_cast<float>(tool.orientation.x);
    commanded.orientation[2] = static_cast<float>(tool.orientation.y);
    commanded.orientation[3] = static_cast<float>(tool.orientation.z);
    return commanded;
}

// Values of TickInput::checkpoint_action. `save_checkpoint` stores the state of all nuts; the newest
// `max_checkpoints` are kept. 1 restores the newest checkpoint, 2 the one before it, and so on up to
// `max_checkpoints`. A restore undoes steps.
inline constexpr std::uint8_t max_checkpoints = 8, save_checkpoint = 255;

struct TickInput {
    CommandedTool commanded_tool;
    Grip grip = Grip::none;
    bool dead_man = false;  // the dead-man switch is held; otherwise the output is zero
    std::int16_t guided_joint =
        -1;  // index of the joint that the guiding force leads to; −1: no guiding force

    bool fresh = true;   // a device sample arrived since the last tick; the watchdog stops a silent device
    bool stop = false;   // emergency stop pressed; latches until `reset`
    bool reset = false;  // releases the stop if neither dead-man switch nor stop is pressed
    std::uint8_t missed = 0;  // deadlines without a tick since the last tick, at most 15
    // `save_checkpoint`, 1 … `max_checkpoints` to restore, or 0: none. A restore is ignored while a nut is
    // held or the tool is within 12 cm of a nut.
    std::uint8_t checkpoint_action = 0;
    // N·m on the scale of a click-type torque wrench; 0: it does not click. Ignored from the click until the
    // mechanism has swung back.
    float set_torque = 0.0F;
    // Index in Setup::tools of the tool that the hand gets when it next takes one. change_tool() (tick.hpp)
    // puts this tool into use while the hand holds neither a tool nor a nut.
    std::uint8_t tool = 0;
    // Index of the joint whose held part the second wrench is on; −1: on none. It acts on joints with
    // joint::CounterHold::second_wrench.
    std::int16_t second_wrench = -1;
};

struct Output {
    // Device output after scaling and the limits of the output stage, N and N·m. It acts at the tool's origin
    // or, on a device without torque output, at the end of the wrench's handle.
    Vec3 force{0.0};
    Vec3 torque{0.0};

    force::Fault fault = force::Fault::none;  // reason for which the output is zero

    Pose constrained_tool;  // pose that contacts permit, in the assembly's frame
    // Number of contacts in the tick's last query at a pose of the tool, also with obstacles that the tool is
    // only near to (GodObjectStep::contacts).
    std::uint16_t contacts = 0;
    // The nearest obstacle in contact at the pose of the tick's last contact query; none without a contact.
    // That pose can differ from `constrained_tool`.
    collision::ObstacleId touched;

    // Physical values, before scaling to the device.
    std::int16_t joint = -1;  // engaged joint; −1: none
    joint::Stage stage = joint::Stage::navigation;
    double wrench_torque = 0.0;  // N·m about the bolt's axis, tightening positive
    double nut_angle = 0.0;      // rad, tightening positive; 0 where the hand starts the nut on its thread
    double clamp = 0.0;          // clamp force, N

    std::int16_t slipped = -1;  // joint over whose corners the tool's head slipped in this tick; −1: none
    bool clicked = false;       // the torque wrench clicked in this tick
    std::uint8_t undone = 0;    // checkpoint that was restored in this tick, 1: the newest; 0: none
    // m that the corners of the engaged or slipped nut have lost along each flat (joint::CornerGrip::rounded)
    double rounded = 0.0;
};

}  // namespace bolt::servo
