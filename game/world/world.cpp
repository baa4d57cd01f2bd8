#include "game/world/world.hpp"

#include <algorithm>
#include <cassert>

namespace bolt::world {

namespace {

Pose pose_of_input(const servo::TickInput& input) {
    const servo::ToolPose pose = servo::tool_pose(input.commanded_tool);
    return {pose.position, pose.orientation};
}

void write_hand(WorkingHand& hand, const Snapshot& servo) {
    const bool engaged = servo.output.joint >= 0;
    hand.action = engaged ? HandAction::holding : HandAction::resting;
    hand.wrench = servo.input.grip == servo::Grip::wrench;
    hand.pinches = servo.input.grip == servo::Grip::fingers;
    hand.nut = engaged ? std::optional(static_cast<std::size_t>(servo.output.joint)) : std::nullopt;
    hand.pose = hand.to = pose_of_input(servo.input);
}

void write_joints(const WriteHaptics& world, const servo::State& servo) {
    for (Joint& joint : world.pool<Joint>().components()) {
        const joint::JointState& state = servo.joints[joint.index];
        joint.stage = state.stage;
        joint.condition = state.condition;
        joint.angle = state.nut.angle;
        joint.speed = state.nut.speed;
        joint.torque = state.torque;
        joint.clamp = state.clamp;
        joint.breakaway = state.breakaway;
        joint.rounded = servo.rounded[joint.index];
        joint.common_turn = state.common_turn;
    }
}

}  // namespace

void write_initial_state(const WriteHaptics& world, const servo::State& state) {
    world.only<ServoClock>().tick = state.tick;
    write_joints(world, state);
}

void write_haptics(const WriteHaptics& world, const Snapshot& servo) {
    const servo::Output& output = servo.output;
    world.only<ServoClock>().tick = servo.state.tick;
    write_joints(world, servo.state);
    world.only<ConstrainedTool>().pose = output.constrained_tool;
    world.only<ToolState>() = {output.joint,
                               servo.state.engagement.grip,
                               output.slipped,
                               output.touched,
                               output.contacts,
                               output.clicked,
                               servo.state.engagement.ratchet_slack,
                               servo.input.second_wrench,
                               servo.state.bent};
    world.only<GuidingForce>() = {servo.input.guide, servo.state.guiding_command.force,
                                  servo.state.guiding_command.torque};
    world.only<DeviceForce>() = {output.force, output.torque, output.fault};
    write_hand(world.only<WorkingHand>(), servo);
}

const Joint& joint_at(const ReadJoints& world, std::size_t index) {
    const auto joints = world.pool<Joint>().components();
    // Joints are created in order and never destroyed, so the position is usually the index.
    if (index < joints.size() && joints[index].index == index) return joints[index];
    const auto found =
        std::find_if(joints.begin(), joints.end(), [&](const Joint& joint) { return joint.index == index; });
    assert(found != joints.end());
    return *found;
}

Vec3 nut_centre(const ReadJoints& world, const servo::Setup& setup, std::size_t joint) {
    return servo::nut_centre(setup.nuts[joint], joint_at(world, joint).angle);
}

}  // namespace bolt::world
