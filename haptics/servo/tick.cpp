#include "haptics/servo/tick.hpp"

#include <algorithm>
#include <cmath>

#include "haptics/servo/denormals.hpp"

namespace bolt::servo {

namespace {

joint::Handle handle_of(const Setup& setup, const Engagement& e) {
    joint::Handle handle;
    handle.engaged = e.joint >= 0;
    handle.angle = e.hand_angle;
    if (e.grip == Grip::wrench) {
        handle.half_play = setup.wrench.half_play;
        handle.stiffness = setup.wrench.stiffness;
    } else {
        handle.stiffness = setup.finger_stiffness;
        handle.torque_limit = setup.finger_torque(setup.nuts[static_cast<std::size_t>(std::max(e.joint, 0))]);
    }
    return handle;
}

// Fingertips that slip do not wind up: the grip moves on so that it just holds its limit.
void let_slip(const Setup& setup, Engagement& e, double nut_angle) {
    const double most =
        setup.finger_torque(setup.nuts[static_cast<std::size_t>(e.joint)]) / setup.finger_stiffness;
    e.hand_angle = nut_angle + std::clamp(e.hand_angle - nut_angle, -most, most);
}

// What the hand feels while it holds a nut: the joint about the bolt's axis, the nut's place in the rest.
force::OutputCommand held(const Setup& setup, const State& state, const ToolPose& tool) {
    const auto i = static_cast<std::size_t>(state.engagement.joint);
    const NutPlace& nut = setup.nuts[i];
    const double torque = state.joints[i].torque;
    force::OutputCommand command;
    const Vec3 target = nut_centre(nut, state.joints[i].nut.angle) + state.engagement.held_at;
    command.force = setup.hold_stiffness * (target - tool.position);
    // Tightening turns about −axis; the nut's answer is about +axis.
    command.torque = nut.axis * (torque * setup.torque_scale);
    command.force += glm::cross(nut.axis, tool.handle) * (torque * setup.torque_as_force);
    if (state.engagement.grip == Grip::wrench) {
        const Vec3 square_to = glm::dot(tool.normal, nut.axis) < 0.0 ? -nut.axis : nut.axis;
        // The joint's torque goes first; keeping the wrench square takes what range is left.
        const double room = std::max(0.0, setup.limits.torque - std::abs(torque * setup.torque_scale));
        const Vec3 torsion = setup.hold_torsion * glm::cross(tool.normal, square_to);
        command.torque += torsion * std::min(1.0, room / std::max(glm::length(torsion), 1e-9));
    }
    return command;
}

}  // namespace

State initial_state(const Setup& setup) {
    State state;
    state.joints = joint::initial_state(setup.group, setup.nuts.size());
    return state;
}

Output tick(const Setup& setup, State& state, const Input& input) {
    const FlushDenormals flush;
    const ToolPose tool = pose_of(input.device);
    const Grip grip = input.enabled ? input.grip : Grip::none;
    update_engagement(setup, state.joints, tool, grip, state.engagement);

    const int engaged = state.engagement.joint;
    step_group(setup.group, state.joints, engaged, handle_of(setup, state.engagement), setup.dt);

    Output output;
    force::OutputCommand wanted;
    if (engaged >= 0) {
        const auto i = static_cast<std::size_t>(engaged);
        const joint::JointState& joint = state.joints[i];
        if (state.engagement.grip == Grip::fingers) let_slip(setup, state.engagement, joint.nut.angle);
        wanted = held(setup, state, tool);
        output.joint = static_cast<std::int16_t>(engaged);
        output.stage = joint.stage;
        output.wrench_torque = joint.torque;
        output.nut_angle = joint.nut.angle;
        output.clamp = joint.clamp;
    } else if (tool.valid && input.guide >= 0 && static_cast<std::size_t>(input.guide) < setup.nuts.size()) {
        const auto i = static_cast<std::size_t>(input.guide);
        wanted.force = force::guiding_force(setup.guiding, tool.position,
                                            nut_centre(setup.nuts[i], state.joints[i].nut.angle));
    }
    force::PortInput port;
    port.pose = {tool.position, tool.orientation};
    port.valid = tool.valid;
    port.enabled = input.enabled;
    const force::OutputCommand limited = force::render(setup.limits, state.output, port, {wanted}, setup.dt);
    output.force = limited.force;
    output.torque = limited.torque;
    ++state.tick;
    return output;
}

}  // namespace bolt::servo
