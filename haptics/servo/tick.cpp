#include "haptics/servo/tick.hpp"

#include <algorithm>
#include <cmath>

#include "haptics/servo/denormals.hpp"
#include "haptics/servo/jaw_grip.hpp"
#include "haptics/servo/lead.hpp"

namespace bolt::servo {

namespace {

// Whether contacts hold what is engaged.
bool by_contact(const State& state) { return state.touch && state.engagement.grip == Grip::wrench; }

// Under way a scale that turned would make energy.
void set_wrench(const Setup& setup, Engagement& e, float scale) {
    if (e.swung > 0.0) return;
    const bool clicks = e.grip == Grip::wrench && setup.wrench.click.swing > 0.0;
    e.setting = clicks && std::isfinite(scale) ? std::max(static_cast<double>(scale), 0.0) : 0.0;
}

joint::Handle rigid_handle(const Setup& setup, const State& state) {
    const Engagement& e = state.engagement;
    if (e.joint >= 0 && by_contact(state)) {
        const auto i = static_cast<std::size_t>(e.joint);
        return jaw_handle(setup, setup.nuts[i], state.rounded[i], e);
    }
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

joint::Handle handle_of(const Setup& setup, const State& state) {
    const Engagement& e = state.engagement;
    joint::Handle handle = rigid_handle(setup, state);
    handle.click = setup.wrench.click;
    handle.click.setting = e.setting * (1.0 + setup.wrench.deviation);
    handle.swung = e.swung;
    return handle;
}

// Fingertips that slip do not wind up: the grip moves on so that it just holds its limit.
void let_slip(const Setup& setup, Engagement& e, double nut_angle) {
    const double most =
        setup.finger_torque(setup.nuts[static_cast<std::size_t>(e.joint)]) / setup.finger_stiffness;
    e.hand_angle = nut_angle + std::clamp(e.hand_angle - nut_angle, -most, most);
}

constexpr double opening_time = 0.05;  // s

double spring_energy(double stiffness, const Vec3& stretch) {
    return 0.5 * stiffness * glm::dot(stretch, stretch);
}

// What the hand feels while it holds a nut: the joint about the bolt's axis, and the nut's place in the rest
// where contacts do not give that.
force::Wanted held(const Setup& setup, State& state, const ToolPose& tool, bool held_before) {
    const auto i = static_cast<std::size_t>(state.engagement.joint);
    const NutPlace& nut = setup.nuts[i];
    const double torque = state.joints[i].torque;
    const Vec3 target = nut_centre(nut, state.joints[i].nut.angle) + state.engagement.held_at;
    force::Wanted wanted;
    wanted.command = force::render_torque(setup.torque, torque, nut.axis, tool.handle);
    const double stiffness =
        state.engagement.grip == Grip::wrench ? setup.wrench.stiffness : setup.finger_stiffness;
    wanted.stored = force::stored_torque(setup.torque, torque, stiffness, setup.wrench.handle_length);
    if (by_contact(state)) return wanted;
    const Vec3 off = target - tool.position;
    wanted.command.force += setup.hold_stiffness * off;
    const double hold = spring_energy(setup.hold_stiffness, off);
    wanted.stored += hold;
    // The place that it is held at moves with the nut, and to its middle: that is no work of the hand.
    const Vec3 moved = target - (held_before ? state.drawn_to : target);
    wanted.granted = hold - spring_energy(setup.hold_stiffness, off - moved);
    state.drawn_to = target;
    if (state.engagement.grip == Grip::wrench && setup.limits.torque > 0.0) {
        const Vec3 square_to = glm::dot(tool.normal, nut.axis) < 0.0 ? -nut.axis : nut.axis;
        // The joint's torque goes first; keeping the wrench square takes what range is left.
        const double room = std::max(0.0, setup.limits.torque - std::abs(torque * setup.torque.scale));
        const Vec3 torsion = force::at_most(setup.hold_torsion * glm::cross(tool.normal, square_to), room);
        wanted.command.torque += torsion;
        wanted.stored += 0.5 * glm::dot(torsion, torsion) / setup.hold_torsion;
    }
    return wanted;
}

// What is left of the hold on a nut that was let go of.
force::Wanted opens(const Setup& setup, Opening& opening, const ToolPose& tool) {
    force::Wanted wanted;
    opening.share = std::max(0.0, opening.share - setup.dt / opening_time);
    const Vec3 off = opening.drawn_to - tool.position;
    wanted.command.force = opening.share * setup.hold_stiffness * off;
    wanted.stored = spring_energy(opening.share * setup.hold_stiffness, off);
    return wanted;
}

// The guiding force pulls at the hand and is a potential of the tool. Where contacts hold the tool back the
// hand goes other ways than it does, and the work of that is help, as it is meant to be.
double work_beside(const force::OutputCommand& help, const Pose& hand_before, const Pose& hand,
                   const Pose& tool_before, const Pose& tool) {
    const auto turn = [](const Pose& from, const Pose& to) {
        return rotation_vector(glm::normalize(to.orientation * glm::conjugate(from.orientation)));
    };
    const Vec3 beside = (hand.position - hand_before.position) - (tool.position - tool_before.position);
    return glm::dot(help.force, beside) +
           glm::dot(help.torque, turn(hand_before, hand) - turn(tool_before, tool));
}

constexpr double out_of_the_way = 0.12;  // m, of a tool from nuts that are to leap

// What an instructor's hand, or an undo, does between two ticks: no work of the trainee's.
std::uint8_t go_back(const Setup& setup, State& state, const ToolPose& tool, std::uint8_t undo) {
    if (undo == keep_mark) {
        Mark& mark = state.marks.at(state.marked++ % most_marks);
        std::copy(state.joints.begin(), state.joints.end(), mark.joints.begin());
        std::copy(state.rounded.begin(), state.rounded.end(), mark.rounded.begin());
        return 0;
    }
    if (undo == 0 || undo > std::min<std::uint32_t>(state.marked, most_marks)) return 0;
    if (state.engagement.joint >= 0) return 0;
    for (std::size_t i = 0; i < setup.nuts.size(); ++i)
        if (tool.valid && glm::distance(tool.position, nut_centre(setup.nuts[i], state.joints[i].nut.angle)) <
                              out_of_the_way)
            return 0;
    const Mark& mark = state.marks.at((state.marked - undo) % most_marks);
    std::copy(mark.joints.begin(), mark.joints.end(), state.joints.begin());
    std::copy(mark.rounded.begin(), mark.rounded.end(), state.rounded.begin());
    state.marked -= undo - 1U;  // what came after it is no more; the mark itself stays
    return undo;
}

}  // namespace

State initial_state(const Setup& setup) {
    State state;
    state.joints = joint::initial_state(setup.group, setup.nuts.size());
    state.rounded.assign(setup.nuts.size(), 0.0);
    state.marks.fill({state.joints, state.rounded});
    return state;
}

Output tick(const Setup& setup, State& state, const Input& input) {
    return tick(setup, state, input, [&](const Vec3& from, const Vec3& to) {
        return !state.touch || !hidden(*state.touch, from, to, input.guide);
    });
}

Output tick(const Setup& setup, State& state, const Input& input, force::Free free) {
    const FlushDenormals flush;
    const ToolPose hand = pose_of(input.device);
    const std::uint8_t undone = input.undo != 0 ? go_back(setup, state, hand, input.undo) : std::uint8_t{0};
    const Grip grip = input.enabled ? input.grip : Grip::none;
    force::Wanted bumps;
    ToolPose tool = hand;
    if (state.touch && hand.valid) {
        const contact::GodObjectState before = state.touch->god_object;
        const bool in_hand = state.touch->in_hand;
        const Pose now{hand.position, hand.orientation};
        bumps =
            step_touch(setup, *state.touch, state.joints, now, grip == Grip::wrench, state.engagement.joint);
        const Pose& tool_now = state.touch->god_object.tool;
        if (grip == Grip::wrench) tool = at_pose(tool_now);
        if (in_hand && grip == Grip::wrench)
            bumps.granted += work_beside(state.helped, before.device, now, before.tool, tool_now);
    }
    const int engaged_before = state.engagement.joint;
    const bool drawn_before = engaged_before >= 0 && !by_contact(state);
    if (state.touch && grip == Grip::wrench)
        update_jaw_grip(setup, state.joints, state.rounded, tool, state.engagement);
    else
        update_engagement(setup, state.joints, tool, grip, state.engagement);

    const int engaged = state.engagement.joint;
    set_wrench(setup, state.engagement, input.setting);
    const joint::ClickStep click =
        step_group(setup.group, state.joints, engaged, handle_of(setup, state), setup.dt);
    state.engagement.swung = click.swung;

    Output output;
    output.clicked = click.clicked;
    output.undone = undone;
    force::Wanted wanted;
    // Engaged it has come there, and without a pose there is nobody to lead: what help there was fades.
    const bool leads = engaged < 0 && tool.valid && input.enabled;
    // On its way to a nut.
    const force::Wanted help =
        force::guide(setup.guiding, state.guide, guided_tool(setup, tool),
                     goal_at(setup, state.joints, leads ? input.guide : -1), free, setup.dt);
    state.helped = help.command;
    if (drawn_before && engaged != engaged_before) state.opening = {state.drawn_to, 1.0};
    if (!tool.valid || !input.enabled) state.opening.share = 0.0;
    const force::Wanted opening = opens(setup, state.opening, tool);
    if (engaged >= 0) {
        const auto i = static_cast<std::size_t>(engaged);
        const joint::JointState& joint = state.joints[i];
        if (state.engagement.grip == Grip::fingers) let_slip(setup, state.engagement, joint.nut.angle);
        wanted = held(setup, state, tool, engaged_before == engaged);
        const bool slips = by_contact(state) &&
                           round_corners(setup, setup.nuts[i], joint, state.rounded[i], state.engagement);
        (slips ? output.slipped : output.joint) = static_cast<std::int16_t>(engaged);
        output.rounded = state.rounded[i];
        output.stage = joint.stage;
        output.wrench_torque = joint.torque;
        output.nut_angle = joint.nut.angle;
        output.clamp = joint.clamp;
    }
    if (tool.valid)
        for (const force::Wanted& more : {help, bumps, opening}) {
            wanted.command.force += more.command.force;
            wanted.command.torque += more.command.torque;
            wanted.stored += more.stored;
            wanted.granted += more.granted;
        }
    force::PortInput port;
    // A device without torque has its force at the grip.
    const double grip_at = setup.limits.torque > 0.0 ? 0.0 : setup.wrench.handle_length;
    port.pose = {hand.position + grip_at * hand.handle, hand.orientation};
    port.valid = hand.valid;
    port.enabled = input.enabled;
    port.fresh = input.fresh;
    port.missed = input.missed;
    port.stop = input.stop;
    port.reset = input.reset;
    const force::OutputCommand limited = force::render(setup.limits, state.output, port, wanted, setup.dt);
    output.tool = {tool.position, tool.orientation};
    output.contacts = state.touch ? static_cast<std::uint16_t>(state.touch->last.contacts) : std::uint16_t{0};
    output.touched = state.touch ? static_cast<std::int16_t>(state.touch->touched) : std::int16_t{-1};
    output.force = limited.force;
    output.torque = limited.torque;
    output.fault = state.output.watchdog.fault;
    ++state.tick;
    return output;
}

}  // namespace bolt::servo
