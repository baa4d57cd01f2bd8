#include "game/world/world.hpp"

#include <algorithm>
#include <cassert>

namespace bolt::world {

namespace {

void write_hand(WorkingHand& hand, const Snapshot& servo) {
    const bool engaged = servo.output.joint >= 0;
    hand.action = engaged ? HandAction::holding : HandAction::resting;
    hand.wrench = servo.input.grip == servo::Grip::wrench;
    hand.pinches = servo.input.grip == servo::Grip::fingers;
    hand.nut = engaged ? std::optional(static_cast<std::size_t>(servo.output.joint)) : std::nullopt;
    hand.pose = hand.to = servo::commanded_pose(servo.input.commanded_tool).value_or(Pose{});
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

// rad between two angles at which the head of a ratchet fits the same hexagon.
double hexagon_period(const collision::ToolHead& head) {
    const auto* ring = std::get_if<collision::Ring>(&head);
    return to_radians(ring != nullptr && ring->points == 12 ? 30.0 : 60.0);
}

// Writes all members but ToolState::head_turn, which turn_ratchet_head() writes.
void write_tool(ToolState& tool, const Snapshot& servo) {
    const servo::Output& output = servo.output;
    tool.joint = output.joint;
    tool.grip = servo.state.engagement.grip;
    tool.slipped = output.slipped;
    tool.obstacle = output.touched;
    tool.contacts = output.contacts;
    tool.clicked = output.clicked;
    tool.ratchet_slack = servo.state.engagement.ratchet_slack;
    tool.second_wrench = servo.input.second_wrench;
    tool.bent = servo.state.bent;
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
    write_tool(world.only<ToolState>(), servo);
    world.only<GuidingForce>() = {servo.input.guided_joint, servo.state.guiding_command.force,
                                  servo.state.guiding_command.torque};
    world.only<DeviceForce>() = {output.force, output.torque, output.fault};
    write_hand(world.only<WorkingHand>(), servo);
}

void turn_ratchet_head(const WriteHaptics& world, const servo::Setup& setup, const Snapshot& servo) {
    double& head_turn = world.only<ToolState>().head_turn;
    if (setup.wrench.ratchet.tooth_angle <= 0.0 || servo.input.grip != servo::Grip::wrench) {
        head_turn = 0.0;
        return;
    }
    const servo::Engagement& engagement = servo.state.engagement;
    if (engagement.joint < 0 || engagement.grip != servo::Grip::wrench) return;
    const auto i = static_cast<std::size_t>(engagement.joint);
    const servo::NutGeometry& nut = setup.nuts[i];
    const double play = servo::half_play(setup.wrench, nut.across_flats, servo.state.rounded[i]);
    const double rotation = servo.state.joints[i].rotation();
    // Beyond the play, the tool twists: the head stays on the hexagon.
    const double head = rotation + std::clamp(engagement.hand_angle - rotation, -play, play);
    const Vec3 tool_axis = servo.output.constrained_tool.orientation * Vec3(0.0, 0.0, 1.0);
    const double about_axis = glm::dot(tool_axis, nut.axis) < 0.0 ? -1.0 : 1.0;
    const double turn = -nut.sense * about_axis * (head - engagement.azimuth);
    // The nearest rotation that fits. A head put on at another angle turns to it within 0.06 s.
    constexpr double highest_speed = 10.0;  // rad/s, more than a handle swings
    const double left = wrap(turn - head_turn, hexagon_period(setup.wrench.head));
    head_turn += std::clamp(left, -highest_speed * setup.dt, highest_speed * setup.dt);
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
