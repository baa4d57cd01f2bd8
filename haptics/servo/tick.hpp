// The servo tick: a pure step of fixed dt. No clock, lock, allocation or I/O; the same inputs give the same
// bits.
//
//   1 commanded pose → constrained pose of the tool         tool_contact.hpp
//   2 engagement of a nut                                   engagement.hpp
//   3 nut and joint: angle, stage, torque                   joint/group.hpp
//   4 forces on the hand: of the nut, and the guiding force  force/guide.hpp
//   5 output stage: watchdog, passivity, limits             force/output_stage.hpp
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "haptics/force/guide.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::servo {

// The hold spring pulls an engaged tool to the centre of the nut. Contacts replace it for a wrench with
// contact simulation. After a release the spring fades out within 50 ms instead of in one step.
struct ReleaseFade {
    Vec3 hold_target{0.0};  // m, point to which the fading spring pulls the tool
    double share = 0.0;     // remaining share of Setup::hold_stiffness, 0 … 1
};

// A stored state of all joints and nuts, for undo.
struct Checkpoint {
    std::vector<joint::JointState> joints;
    std::vector<double> rounded;  // by joint: length removed from each flat, m (State::rounded)
};

struct State {
    std::uint64_t tick = 0;  // number of ticks since the beginning
    std::vector<joint::JointState> joints;
    // By joint: m of each of the nut's flats that slipping tools have worn away at each of its corners
    // (joint::CornerGrip::rounded).
    std::vector<double> rounded;
    double bent = 0.0;  // rad by which tools were bent for good; undo does not reduce it
    Engagement engagement;
    Vec3 hold_target{0.0};  // m, point to which the hold spring pulls an engaged tool
    ReleaseFade release_fade;
    force::OutputCommand guiding_command;  // guiding force and torque of the last tick
    force::GuideState guide_state;
    force::OutputStage output_stage;
    // m, from the tool's origin to the point at which the device's force acts: the end of the handle for a
    // device without torque output, otherwise 0.
    double lever_arm = 0.0;
    std::optional<ToolContact> tool_contact;              // none: no contact simulation
    std::array<Checkpoint, max_checkpoints> checkpoints;  // ring buffer
    std::uint32_t checkpoint_count = 0;  // saved since the beginning, less those that undo discarded
};

State initial_state(const Setup& setup);

// Puts the tool that TickInput::tool names into use, if it is a tool of the lesson and the hand holds neither
// a tool nor a nut. Call it before each tick. Does not allocate.
void change_tool(Setup& setup, State& state, const TickInput& input);

// One tick. `free` returns true if the straight segment between two points crosses no obstacle; the guiding
// force plans its path with this function. The first overload queries State::tool_contact, so without contact
// simulation every segment is free.
Output tick(const Setup& setup, State& state, const TickInput& input);
Output tick(const Setup& setup, State& state, const TickInput& input, force::IsSegmentFree free);

// The position of a tool, the direction of its head, and its normal, which is the z axis of the tool's frame
// and lies along the bolt when the tool is on a nut. The guiding force needs them.
force::GuidedTool guided_tool(const Setup& setup, const ToolPose& tool);

// The nut of `joint`, at its present angle, as the target of the guiding force. Returns a target with id −1
// if `joint` is not an index of setup.nuts.
force::GuideTarget guide_target(const Setup& setup, std::span<const joint::JointState> joints, int joint);

}  // namespace bolt::servo
