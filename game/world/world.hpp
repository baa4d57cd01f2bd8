// The state of the work as ECS components: plain data that write_haptics() copies from the servo after each
// tick. Lesson, hints, HUD, sound and drawing read it here. A world without drawing has only these
// components; the scene adds its own (WorldWith). Lengths in m, angles in rad, forces in N, torques in N·m,
// poses in the assembly's frame.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/base/math.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/ecs/system.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/joint/stage.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::world {

// The number of ticks since the start of the lesson.
struct ServoClock {
    std::uint64_t tick = 0;
};

// A bolted joint; one entity for each joint of the assembly.
struct Joint {
    std::size_t index = 0;  // in the assembly
    joint::Stage stage = joint::Stage::navigation;
    joint::JointCondition condition = joint::JointCondition::intact;
    double angle = 0.0;   // of the nut; 0 where the hand starts it on its thread, tightening positive
    double speed = 0.0;   // rad/s of the nut
    double torque = 0.0;  // of wrench or fingers on the nut, tightening positive
    double clamp = 0.0;   // clamp force
    double breakaway =
        0.0;  // 0 … 1, share of the breakaway friction that is active: 1 at rest, 0 while it slides
    double rounded = 0.0;      // m of each flat that slipping jaws have rounded off
    double common_turn = 0.0;  // by which nut and bolt have turned together (joint::JointState)
};

// The tool at the pose that the obstacles permit: the wrench in the hand, or the fingertips of an empty hand.
struct ConstrainedTool {
    Pose pose;
};

// The reading of a torque wrench in the due step: below the step's window, in it or above it.
enum class TargetState : std::uint8_t { below, reached, exceeded };

// The tool in the hand: its contact with nuts and obstacles, and its state. A joint is −1 if there is none.
struct ToolState {
    std::int16_t joint = -1;               // engaged joint
    servo::Grip grip = servo::Grip::none;  // what holds the engaged joint
    std::int16_t slipped = -1;             // joint on which the jaw slipped over the corners in this tick
    collision::ObstacleId obstacle;        // obstacle that the wrench touches
    std::uint16_t contacts = 0;            // contacts that bear, and those so near that they may soon
    bool clicked = false;                  // the torque wrench clicked in this tick
    double ratchet_slack = 0.0;            // by which the handle is behind the ratchet's head
    std::int16_t second_wrench = -1;       // joint whose held part the second wrench is on
    double bent = 0.0;                     // rad by which tools were bent for good in this lesson
    // Rotation of a ratchet's head relative to its handle, about the tool's +Z. turn_ratchet_head() computes
    // it, for drawing only.
    double head_turn = 0.0;
    // The lesson writes the next two. `displayed`: the number on an electronic torque wrench, N·m, or degrees
    // in a step that ends at an angle.
    double displayed = 0.0;
    TargetState target = TargetState::below;
};

// The force that guides the tool to a nut, before the limits of the output stage.
struct GuidingForce {
    std::int16_t joint = -1;  // its nut is the target; −1: none
    Vec3 force{0.0};
    Vec3 torque{0.0};
};

// The force that the device renders, after scaling and limits.
struct DeviceForce {
    Vec3 force{0.0};
    Vec3 torque{0.0};
    force::Fault fault = force::Fault::none;  // reason for a zero force
};

enum class HandAction : std::uint8_t {
    resting,    // waits in place
    reaching,   // moves to a nut, to the wrench or to the wrench's resting place
    lowering,   // moves onto a nut
    holding,    // holds a nut with the wrench or the fingers
    easing,     // lets the wrench spring back before lifting it
    lifting,    // moves off a nut
    returning,  // turns the fingers back for the next twist
};

// The working hand, moved by a mouse, a device or a recorded session.
struct WorkingHand {
    HandAction action = HandAction::resting;
    bool wrench = false;             // the wrench is in the hand
    bool pinches = false;            // the fingers are closed on a nut
    double closed_share = 0.0;       // 0 (open) … 1: fingers of an empty hand, by a device's gripper
    std::optional<std::size_t> nut;  // joint that the hand moves to, is at or holds
    Pose pose;                       // commanded pose of the tool or the empty hand
    Pose to;                         // end of a reach
    Pose rest;                       // of the wrench while it is not in the hand
    // Pose of the joint hand::palm, if the hand is empty and a headset measures it.
    std::optional<Pose> palm;
    double twisted = 0.0;  // rad that the fingers have turned since they gripped the nut, tightening positive
    double free_swing =
        std::numeric_limits<double>::infinity();  // angle by which the hand can still turn the tool
};

// The measured joints of a hand with a glove. The hand's entity has this component only while a glove is
// worn.
struct GloveHand {
    // In the frame of the wrench, also while the wrench is at rest. Exception: an empty hand whose pose a
    // headset measures is in the assembly's frame.
    hand::Skeleton joints;
    bool lost = false;  // the glove sends no valid samples
};

// A world with these components and `More`.
template <class... More>
using WorldWith = ecs::Registry<ServoClock, Joint, ConstrainedTool, ToolState, GuidingForce, DeviceForce,
                                WorkingHand, GloveHand, More...>;
using World = WorldWith<>;

using ReadJoints = ecs::Access<const Joint>;
using ReadHaptics = ecs::Access<const ServoClock, const Joint, const ConstrainedTool, const ToolState,
                                const GuidingForce, const DeviceForce, const WorkingHand>;
using WriteHaptics =
    ecs::Access<ServoClock, Joint, ConstrainedTool, ToolState, GuidingForce, DeviceForce, WorkingHand>;

// The servo after a tick.
struct Snapshot {
    const servo::State& state;
    const servo::TickInput& input;
    const servo::Output& output;
};

// Writes the components from the snapshot. It is the first system after each servo tick, in every program
// (session::tick_systems). WorkingHand gets its pose from the input and its nut from the engaged joint; its
// members rest, palm, closed_share, twisted and free_swing stay as they are. A program with more data about
// the hand (its goal, a glove) writes that afterwards.
void write_haptics(const WriteHaptics& world, const Snapshot& servo);

// Turns the head of a ratchet (ToolState::head_turn): on a nut it keeps the nut's angle while the handle
// swings back, and turns with the handle while it pulls. Off the nut it stays as it is until the next nut, or
// until the tool is put down. Call after write_haptics().
void turn_ratchet_head(const WriteHaptics& world, const servo::Setup& setup, const Snapshot& servo);

// Writes the state at the start of a lesson, when there is no input or output yet.
void write_initial_state(const WriteHaptics& world, const servo::State& state);

// Creates the entities: one for each joint, one for the tool, one for the hand. `rest`: WorkingHand::rest.
template <class Registry>
void add_haptics(Registry& world, const servo::State& state, const Pose& rest = {}) {
    for (std::size_t i = 0; i < state.joints.size(); ++i) world.template add<Joint>(world.create()).index = i;
    const ecs::Entity tool = world.create();
    world.template add<ServoClock>(tool);
    world.template add<ConstrainedTool>(tool);
    world.template add<ToolState>(tool);
    world.template add<GuidingForce>(tool);
    world.template add<DeviceForce>(tool);
    world.template add<WorkingHand>(world.create()).rest = rest;
    write_initial_state(world, state);
}

// Returns the joint with this index, which must exist.
const Joint& joint_at(const ReadJoints& world, std::size_t index);

// Centre of a joint's nut, which moves along the bolt as it turns.
Vec3 nut_centre(const ReadJoints& world, const servo::Setup& setup, std::size_t joint);

}  // namespace bolt::world
