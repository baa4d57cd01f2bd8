#include "haptics/servo/tick.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/servo/denormals.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

namespace {

// Returns true if contacts, not the hold spring, keep the engaged tool in place.
bool held_by_contact(const State& state) {
    return state.tool_contact && state.engagement.grip == Grip::wrench;
}

// After the click a changed set torque would create energy, so it is ignored.
void update_set_torque(const Setup& setup, Engagement& e, float scale) {
    if (e.swung > 0.0) return;
    const bool clicks = e.grip == Grip::wrench && setup.wrench.click.swing > 0.0;
    e.set_torque = clicks && std::isfinite(scale) ? std::max(static_cast<double>(scale), 0.0) : 0.0;
}

joint::NutDrive drive_without_click(const Setup& setup, const State& state) {
    const Engagement& e = state.engagement;
    if (e.joint >= 0 && held_by_contact(state)) {
        const auto i = static_cast<std::size_t>(e.joint);
        return contact_drive(setup, setup.nuts[i], state.rounded[i], e);
    }
    joint::NutDrive drive;
    drive.engaged = e.joint >= 0;
    drive.angle = e.hand_angle;
    if (e.grip == Grip::wrench) {
        drive.half_play = setup.wrench.half_play;
        drive.stiffness = setup.wrench.stiffness;
    } else {
        drive.stiffness = setup.finger_stiffness;
        drive.torque_limit = setup.finger_torque(setup.nuts[static_cast<std::size_t>(std::max(e.joint, 0))]);
    }
    return drive;
}

// The external torque, N·m, that the held part of the engaged joint can bear. While the fingers of one hand
// turn a nut or head, those of the other hand hold the held part.
double held_part_torque(const Setup& setup, const Engagement& e, int second_wrench) {
    if (e.joint < 0 || second_wrench == e.joint) return std::numeric_limits<double>::infinity();
    if (e.grip != Grip::fingers) return 0.0;
    return 0.5 * setup.finger_force * setup.nuts[static_cast<std::size_t>(e.joint)].held_across_flats;
}

joint::NutDrive drive_of(const Setup& setup, const State& state, int second_wrench) {
    const Engagement& e = state.engagement;
    joint::NutDrive drive = drive_without_click(setup, state);
    drive.held_part_torque = held_part_torque(setup, e, second_wrench);
    drive.click = setup.wrench.click;
    drive.click.set_torque = e.set_torque * setup.wrench.adaptor_ratio * (1.0 + setup.wrench.deviation);
    drive.swung = e.swung;
    return drive;
}

// Slipping fingertips do not wind up: the hand angle is clamped to the deflection at the largest finger
// torque.
void clamp_finger_deflection(const Setup& setup, Engagement& e, double rotation) {
    const double most =
        setup.finger_torque(setup.nuts[static_cast<std::size_t>(e.joint)]) / setup.finger_stiffness;
    e.hand_angle = rotation + std::clamp(e.hand_angle - rotation, -most, most);
}

constexpr double release_fade_time = 0.05;  // s

double spring_energy(double stiffness, const Vec3& stretch) {
    return 0.5 * stiffness * glm::dot(stretch, stretch);
}

// Force of an engaged nut on the hand: the joint's torque about the bolt's axis and, without contact
// simulation, the hold spring in the other directions.
force::ForceRequest hold_request(const Setup& setup, State& state, const ToolPose& tool, bool held_before) {
    const auto i = static_cast<std::size_t>(state.engagement.joint);
    const NutGeometry& nut = setup.nuts[i];
    const double torque = state.joints[i].torque;
    const Vec3 target = nut_centre(nut, state.joints[i].nut.angle) + state.engagement.offset_at_engagement;
    force::ForceRequest request;
    request.command = force::render_torque(setup.torque_rendering, torque, loosening_axis(nut), tool.handle);
    const double stiffness =
        state.engagement.grip == Grip::wrench ? setup.wrench.stiffness : setup.finger_stiffness;
    request.stored_energy =
        force::stored_torque_energy(setup.torque_rendering, torque, stiffness, setup.wrench.handle_length);
    if (held_by_contact(state)) return request;
    const Vec3 off = target - tool.position;
    request.command.force += setup.hold_stiffness * off;
    const double hold = spring_energy(setup.hold_stiffness, off);
    request.stored_energy += hold;
    // The target moves with the nut and, while the offset at the engagement fades, towards its centre. The
    // energy of that motion is not work of the hand.
    const Vec3 moved = target - (held_before ? state.hold_target : target);
    request.injected_energy = hold - spring_energy(setup.hold_stiffness, off - moved);
    state.hold_target = target;
    if (state.engagement.grip == Grip::wrench && setup.limits.torque > 0.0) {
        const Vec3 square_to = glm::dot(tool.normal, nut.axis) < 0.0 ? -nut.axis : nut.axis;
        // The joint's torque has priority; the torsion spring gets the range that is left.
        const double room =
            std::max(0.0, setup.limits.torque - std::abs(torque * setup.torque_rendering.scale));
        const Vec3 torsion =
            force::clamp_length(setup.hold_torsion * glm::cross(tool.normal, square_to), room);
        request.command.torque += torsion;
        request.stored_energy += 0.5 * glm::dot(torsion, torsion) / setup.hold_torsion;
    }
    return request;
}

// The fading hold spring of a nut that was released.
force::ForceRequest release_request(const Setup& setup, ReleaseFade& release_fade, const ToolPose& tool) {
    force::ForceRequest request;
    release_fade.share = std::max(0.0, release_fade.share - setup.dt / release_fade_time);
    const Vec3 off = release_fade.hold_target - tool.position;
    request.command.force = release_fade.share * setup.hold_stiffness * off;
    request.stored_energy = spring_energy(release_fade.share * setup.hold_stiffness, off);
    return request;
}

// A pose in the last tick and in this one.
struct PoseStep {
    Pose before, now;
};

// The work (J) of the guiding force on the motion of the commanded tool relative to the constrained one. The
// guiding force acts on the hand, but derives from a potential of the constrained pose. Where contacts hold
// the tool back, hand and tool move differently, and the difference counts as injected energy.
double relative_work(const force::OutputCommand& guiding, const PoseStep& commanded,
                     const PoseStep& constrained) {
    const Vec3 relative = (commanded.now.position - commanded.before.position) -
                          (constrained.now.position - constrained.before.position);
    return glm::dot(guiding.force, relative) +
           glm::dot(guiding.torque,
                    turn_between(commanded.before.orientation, commanded.now.orientation) -
                        turn_between(constrained.before.orientation, constrained.now.orientation));
}

// Converts the aligning torque to a force at the end of the handle, for a device without torque: near a bolt
// the wrench turns with the end of its handle.
force::OutputCommand as_force_at_lever_end(const Setup& setup, const force::OutputCommand& guiding,
                                           const ToolPose& tool) {
    if (setup.wrench.handle_length <= 0.0) return guiding;
    return {guiding.force + glm::cross(guiding.torque, tool.handle) / setup.wrench.handle_length, Vec3(0.0)};
}

constexpr double undo_clearance = 0.12;  // m between tool and nuts; an undo moves the nuts in one tick

// Saves or restores a checkpoint (TickInput::checkpoint_action). Returns the number of the restored
// checkpoint, 0 if none. A restore changes the energy of the joints, which the hand does not feel, because it
// holds no nut.
std::uint8_t update_checkpoints(const Setup& setup, State& state, const ToolPose& tool, std::uint8_t action) {
    if (action == save_checkpoint) {
        Checkpoint& checkpoint = state.checkpoints.at(state.checkpoint_count++ % max_checkpoints);
        std::copy(state.joints.begin(), state.joints.end(), checkpoint.joints.begin());
        std::copy(state.rounded.begin(), state.rounded.end(), checkpoint.rounded.begin());
        return 0;
    }
    if (action == 0 || action > std::min<std::uint32_t>(state.checkpoint_count, max_checkpoints)) return 0;
    if (state.engagement.joint >= 0) return 0;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i)
        if (tool.valid && glm::distance(tool.position, nut_centre(setup.nuts[i], state.joints[i].nut.angle)) <
                              undo_clearance)
            return 0;
    const Checkpoint& checkpoint = state.checkpoints.at((state.checkpoint_count - action) % max_checkpoints);
    std::copy(checkpoint.joints.begin(), checkpoint.joints.end(), state.joints.begin());
    std::copy(checkpoint.rounded.begin(), checkpoint.rounded.end(), state.rounded.begin());
    state.checkpoint_count -= action - 1U;  // later checkpoints are discarded; the restored one is kept
    return action;
}

// The tool at the pose that contacts permit, and the force of the contacts.
struct ContactResult {
    ToolPose pose;
    force::ForceRequest contacts;
};

// Part 1. Without contact simulation, or without a wrench in the hand, the constrained tool is the commanded
// one.
ContactResult constrain_tool(const Setup& setup, State& state, const ToolPose& commanded_tool, Grip grip) {
    ContactResult constrained{commanded_tool, {}};
    if (!state.tool_contact || !commanded_tool.valid) return constrained;
    const proxy::GodObjectState before = state.tool_contact->god_object;
    const bool was_in_hand = state.tool_contact->in_hand;
    const Pose commanded_now{commanded_tool.position, commanded_tool.orientation};
    constrained.contacts = step_tool_contact(setup, *state.tool_contact, state.joints, commanded_now,
                                             grip == Grip::wrench, state.engagement.joint);
    if (grip != Grip::wrench) return constrained;
    const Pose& constrained_now = state.tool_contact->god_object.constrained_tool;
    constrained.pose = tool_pose(constrained_now);
    if (was_in_hand)
        constrained.contacts.injected_energy +=
            relative_work(state.guiding_command, {before.commanded_tool, commanded_now},
                          {before.constrained_tool, constrained_now});
    return constrained;
}

// Part 2.
void update_engagement(const Setup& setup, State& state, const ToolPose& tool, Grip grip) {
    if (state.tool_contact && grip == Grip::wrench)
        update_contact_engagement(setup, state.joints, state.rounded, tool, state.engagement);
    else
        update_pose_engagement(setup, state.joints, tool, grip, state.engagement);
}

// Part 3. Returns true if the torque wrench clicks.
bool step_joints(const Setup& setup, State& state, const TickInput& input) {
    Engagement& e = state.engagement;
    update_set_torque(setup, e, input.set_torque);
    joint::NutDrive drive = drive_of(setup, state, input.second_wrench);
    const bool turns = e.joint >= 0 && e.grip == Grip::wrench;
    const auto rotation = [&] { return state.joints[static_cast<std::size_t>(e.joint)].rotation(); };
    if (turns) {
        state.bent += bend_tool(setup.wrench, rotation(), drive, e);
        limit_to_pawl(setup.wrench, rotation(), e, drive);
    }
    const joint::ClickStep click = step_group(setup.group, state.joints, e.joint, drive, setup.dt);
    e.swung = click.swung;
    if (turns) settle_ratchet(setup.wrench, rotation(), drive.half_play, e);
    return click.clicked;
}

// Part 4: the guiding force to the nut of `guided_joint`. At −1 the force of the ticks before fades out.
force::ForceRequest guiding_request(const Setup& setup, State& state, const ToolPose& tool, Grip grip,
                                    int guided_joint, force::IsSegmentFree free) {
    force::ForceRequest guiding =
        force::guide(setup.guiding, state.guide_state, guided_tool(setup, tool),
                     guide_target(setup, state.joints, guided_joint), free, setup.dt);
    if (setup.limits.torque <= 0.0 && grip == Grip::wrench)
        guiding.command = as_force_at_lever_end(setup, guiding.command, tool);
    state.guiding_command = guiding.command;
    return guiding;
}

// Part 4, only with a nut in the hand: the nut's force. Writes what the joint does to `output`.
// `held_before`: the same nut was held in the last tick.
force::ForceRequest nut_request(const Setup& setup, State& state, const ToolPose& tool, bool held_before,
                                Output& output) {
    const int engaged = state.engagement.joint;
    const auto i = static_cast<std::size_t>(engaged);
    const joint::JointState& joint = state.joints[i];
    if (state.engagement.grip == Grip::fingers)
        clamp_finger_deflection(setup, state.engagement, joint.rotation());
    const force::ForceRequest request = hold_request(setup, state, tool, held_before);
    const bool slips = held_by_contact(state) &&
                       round_corners(setup, setup.nuts[i], joint, state.rounded[i], state.engagement);
    if (slips)
        output.slipped = static_cast<std::int16_t>(engaged);
    else
        output.joint = static_cast<std::int16_t>(engaged);
    output.rounded = state.rounded[i];
    output.stage = joint.stage;
    output.wrench_torque = joint.torque;
    output.nut_angle = joint.nut.angle;
    output.clamp = joint.clamp;
    return request;
}

void add(force::ForceRequest& sum, const force::ForceRequest& more) {
    sum.command.force += more.command.force;
    sum.command.torque += more.command.torque;
    sum.stored_energy += more.stored_energy;
    sum.injected_energy += more.injected_energy;
}

// Part 5. The input of the output stage. A device without torque output applies its force at the end of the
// handle.
force::DeviceInput device_input(const Setup& setup, State& state, const ToolPose& commanded_tool,
                                const TickInput& input) {
    const double lever_arm = setup.limits.torque > 0.0 ? 0.0 : setup.wrench.handle_length;
    if (setup.renders_tool_in_use) {
        // Another tool has another handle; its end is elsewhere, but the hand has not moved.
        Pose& last = state.output_stage.watchdog.last;
        last.position += (lever_arm - state.lever_arm) * (last.orientation * Vec3(1.0, 0.0, 0.0));
    }
    state.lever_arm = lever_arm;
    force::DeviceInput device;
    device.pose = {commanded_tool.position + lever_arm * commanded_tool.handle, commanded_tool.orientation};
    device.valid = commanded_tool.valid;
    device.dead_man = input.dead_man;
    device.fresh = input.fresh;
    device.missed = input.missed;
    device.stop = input.stop;
    device.reset = input.reset;
    return device;
}

}  // namespace

State initial_state(const Setup& setup) {
    State state;
    state.joints = joint::initial_state(setup.group, setup.nuts.size());
    state.rounded.assign(setup.nuts.size(), 0.0);
    state.checkpoints.fill({state.joints, state.rounded});
    return state;
}

void change_tool(Setup& setup, State& state, const TickInput& input) {
    const std::size_t tool = input.tool;
    if (tool == setup.tool || tool >= setup.tools.size()) return;
    if (input.grip == Grip::wrench || state.engagement.joint >= 0) return;
    if (state.tool_contact) use_tool(*state.tool_contact, setup.tool, tool);
    use_tool(setup, tool);
}

Output tick(const Setup& setup, State& state, const TickInput& input) {
    return tick(setup, state, input, [&](const Vec3& from, const Vec3& to) {
        return !state.tool_contact || !occluded(*state.tool_contact, from, to, input.guided_joint);
    });
}

Output tick(const Setup& setup, State& state, const TickInput& input, force::IsSegmentFree free) {
    const FlushDenormals flush;
    Output output;
    const ToolPose commanded_tool = tool_pose(input.commanded_tool);
    if (input.checkpoint_action != 0)
        output.undone = update_checkpoints(setup, state, commanded_tool, input.checkpoint_action);
    const Grip grip = input.dead_man ? input.grip : Grip::none;

    const auto [tool, contacts] = constrain_tool(setup, state, commanded_tool, grip);

    const int engaged_before = state.engagement.joint;
    const bool held_by_spring_before = engaged_before >= 0 && !held_by_contact(state);
    update_engagement(setup, state, tool, grip);
    const int engaged = state.engagement.joint;

    output.clicked = step_joints(setup, state, input);

    const bool guides = engaged < 0 && tool.valid && input.dead_man;
    const force::ForceRequest guiding =
        guiding_request(setup, state, tool, grip, guides ? input.guided_joint : -1, free);
    if (held_by_spring_before && engaged != engaged_before) state.release_fade = {state.hold_target, 1.0};
    if (!tool.valid || !input.dead_man) state.release_fade.share = 0.0;
    const force::ForceRequest released = release_request(setup, state.release_fade, tool);
    force::ForceRequest request;
    if (engaged >= 0) request = nut_request(setup, state, tool, engaged_before == engaged, output);
    if (tool.valid)
        for (const force::ForceRequest& more : {guiding, contacts, released}) add(request, more);

    const force::OutputCommand limited =
        force::render(setup.limits, state.output_stage, device_input(setup, state, commanded_tool, input),
                      request, setup.dt);
    output.force = limited.force;
    output.torque = limited.torque;
    output.fault = state.output_stage.watchdog.fault;
    output.constrained_tool = {tool.position, tool.orientation};
    if (state.tool_contact) {
        output.contacts = static_cast<std::uint16_t>(state.tool_contact->last_step.contacts);
        output.touched = state.tool_contact->touched;
    }
    ++state.tick;
    return output;
}

force::GuidedTool guided_tool(const Setup& setup, const ToolPose& tool) {
    const Vec3 across = glm::cross(tool.normal, tool.handle);
    const Vec3 head_direction =
        std::cos(setup.wrench.head_angle) * tool.handle + std::sin(setup.wrench.head_angle) * across;
    return {tool.position, head_direction, tool.normal};
}

force::GuideTarget guide_target(const Setup& setup, std::span<const joint::JointState> joints, int joint) {
    force::GuideTarget target;
    const auto i = static_cast<std::size_t>(joint);
    if (joint < 0 || i >= setup.nuts.size()) return target;
    const NutGeometry& nut = setup.nuts[i];
    const double angle = joints[i].rotation();
    target.id = joint;
    target.point = nut_centre(nut, joints[i].nut.angle);
    target.axis = nut.axis;
    // The ball that the target's own nut and bolt end fill; the nut's corners are 0.58 across_flats away.
    target.bounding_radius = 1.2 * std::max(nut.height, nut.across_flats);
    // Hexagon::axis, flat, and across = axis × flat.
    target.hexagon = {nut.axis, std::cos(angle) * nut.e1 - nut.sense * std::sin(angle) * nut.e2,
                      nut.sense * std::sin(angle) * nut.e1 + std::cos(angle) * nut.e2};
    return target;
}

}  // namespace bolt::servo
