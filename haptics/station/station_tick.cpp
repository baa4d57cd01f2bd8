#include "haptics/station/station_tick.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "haptics/servo/tick.hpp"

namespace bolt::station {

using device::Description;
using device::Sensing;

bool renders_force(const Description& d) {
    return d.limits.force > 0.0 && (d.renders[0] || d.renders[1] || d.renders[2]);
}

bool renders_torque(const Description& d) {
    return d.limits.torque > 0.0 && (d.renders[3] || d.renders[4] || d.renders[5]);
}

Status check(const DeviceLayout& layout) {
    if (!layout.mover && !layout.wheel)
        return fail(ErrorCode::no_device, "station: no device is selected", "a device that moves the tool");
    if (layout.mover && layout.mover->sensing == Sensing::angle)
        return fail(ErrorCode::no_device,
                    "station: " + layout.mover->name + " turns about one axis and cannot move the tool",
                    "that device as the wheel, and another device or the mouse as the mover");
    if (layout.wheel && layout.wheel->sensing != Sensing::angle)
        return fail(ErrorCode::no_device, "station: " + layout.wheel->name + " is not a wheel",
                    "a device that turns about one axis; this one can be the mover");
    return {};
}

namespace {

// A larger change of force in a millisecond is felt as a blow. The stiffness and damping of contacts keep the
// change below this share up to 0.5 m/s (haptics/proxy/coupling), but a hand that reaches without looking
// hits the casing at 0.8 m/s.
constexpr double max_slew_share = 0.1;  // of the greatest force and torque, per millisecond
constexpr double millisecond = 1e-3;    // s

force::OutputLimits with_limited_slew_rates(force::OutputLimits limits) {
    limits.force_slew_rate = std::min(limits.force_slew_rate, max_slew_share * limits.force / millisecond);
    limits.torque_slew_rate = std::min(limits.torque_slew_rate, max_slew_share * limits.torque / millisecond);
    return limits;
}

}  // namespace

double lever_arm_of(const DeviceLayout& layout, double handle_length) {
    const bool pose = layout.mover && layout.mover->sensing == Sensing::pose;
    return pose && limits_of(layout).torque <= 0.0 ? handle_length : 0.0;
}

force::OutputLimits limits_of(const DeviceLayout& layout) {
    force::OutputLimits limits;
    limits.force = limits.torque = 0.0;
    if (layout.mover) {
        force::OutputLimits mover = layout.mover->limits;
        if (!renders_force(*layout.mover)) mover.force = 0.0;
        if (!renders_torque(*layout.mover)) mover.torque = 0.0;
        limits = force::in_assembly(layout.workspace, with_limited_slew_rates(mover));
    }
    limits.release -= transport_delay;
    if (!layout.wheel) return limits;
    const force::OutputLimits& wheel = layout.wheel->limits;
    limits.torque = renders_torque(*layout.wheel) ? wheel.torque : 0.0;
    limits.torque_slew_rate = wheel.torque_slew_rate;
    limits.torsion = wheel.torsion;
    limits.angular_damping = wheel.angular_damping;
    limits.angular_speed = wheel.angular_speed;
    limits.angular_jump = wheel.angular_jump;
    limits.delay = std::max(limits.delay, wheel.delay);
    limits.ramp_up = std::max(limits.ramp_up, wheel.ramp_up);
    return limits;
}

namespace {

using device::DeviceSnapshot;

// s without a tick; less than device::SupervisorOptions::command_timeout.
constexpr double servo_stall = 0.010;
constexpr double max_deflection = to_radians(2.5);  // of the wrench, at the largest torque
constexpr double wheel_fade_time = 0.05;            // s in which a wheel's torque fades in and out

bool renders(const Description& d) { return renders_force(d) || renders_torque(d); }

// Updates the link from the snapshot and the share of the force that the device may render.
void update_link(const Description& d, DeviceLink& link, const DeviceSnapshot& snapshot, double elapsed) {
    link.usable = snapshot.usable;
    link.fresh = snapshot.usable && snapshot.number != link.number;
    link.silence = link.fresh ? 0.0 : link.silence + elapsed;
    if (link.fresh) link.number = snapshot.number;
    const force::OutputLimits& limits = d.limits;
    if (!link.usable || link.silence > limits.max_silence) {
        // As in the watchdog, the force is zero `release` s after the last sample.
        const double release = limits.release - transport_delay;
        const double max_share =
            std::max(0.0, (release - link.silence - elapsed) / (release - limits.max_silence));
        link.force_share = link.usable ? std::min(link.force_share, max_share) : 0.0;
    } else {
        link.force_share = std::min(1.0, link.force_share + elapsed / limits.ramp_up);
    }
}

// Returns true if the device's data are current. A device that renders nothing and senses velocity may be
// silent at rest.
bool has_current_data(const Description& d, const DeviceLink& link) {
    return d.sensing == Sensing::pose || renders(d) ? link.fresh : link.usable;
}

// Factor on the angular velocity that a device senses. Above 1 with fingers. With a wrench it falls with the
// transmitted torque; a device that senses velocity gives no other feedback of the torque.
double angular_velocity_factor(const servo::Setup& setup, const StationState& s) {
    if (s.output.joint < 0) return 1.0;
    if (s.input.grip == servo::Grip::fingers) return finger_velocity_factor;
    const double max_torque = setup.wrench.stiffness * max_deflection;
    return 1.0 / (1.0 + torque_slowdown * std::abs(s.output.wrench_torque) / max_torque);
}

// Integrates the velocity that the device senses into the tool's pose, at most the permitted lead ahead of
// the constrained pose.
void integrate_velocity(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                        const device::Sample& sample, const Quat& view, double dt) {
    const Quat to_assembly = view * layout.workspace.rotation;
    Pose& tool = s.workspace.commanded_tool;
    tool.position += to_assembly * sample.velocity * dt;
    const Vec3 turned_on = angular_velocity_factor(setup, s) * (to_assembly * sample.angular_velocity) * dt;
    tool.orientation = glm::normalize(rotation(turned_on) * tool.orientation);
    const Pose& constrained_tool = s.output.constrained_tool;
    tool.position =
        constrained_tool.position + force::clamp_length(tool.position - constrained_tool.position, max_ahead);
    const Vec3 turned = turn_between(constrained_tool.orientation, tool.orientation);
    if (glm::length(turned) > max_angle_ahead)
        tool.orientation = glm::normalize(rotation(force::clamp_length(turned, max_angle_ahead)) *
                                          constrained_tool.orientation);
}

bool on_bolt(const StationState& s) { return s.output.joint >= 0; }

// The view's rotation about the assembly's vertical. The view's x axis is level whatever its pitch.
Quat heading_of(const Quat& view) {
    const Vec3 right = view * Vec3(1.0, 0.0, 0.0);
    return glm::angleAxis(std::atan2(-right.z, right.x), Vec3(0.0, 1.0, 0.0));
}

// Changes heading and lever arm of the mapping without moving the tool.
void set_heading_and_lever_arm(const DeviceLayout& layout, StationState& s, const Quat& heading,
                               double lever_arm) {
    if (heading == s.workspace.heading && lever_arm == s.workspace.lever_arm) return;
    s.workspace.heading = heading;
    s.workspace.lever_arm = lever_arm;
    force::realign(layout.workspace, s.workspace, s.mover_pose, s.workspace.commanded_tool);
}

// Returns true if no hand moves this far between two samples: the device has redetermined its position, or
// one of the samples is wrong.
bool has_jumped(const Description& mover, const Pose& before, const Pose& now) {
    const force::OutputLimits& limits = mover.limits;
    const double between = mover.rate > 0.0 ? 1.0 / mover.rate : 0.0;  // s
    return glm::distance(before.position, now.position) > limits.jump + limits.speed * between ||
           glm::length(turn_between(before.orientation, now.orientation)) >
               limits.angular_jump + limits.angular_speed * between;
}

void move_by_mover(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                   const DeviceSnapshot& snapshot, const Quat& view, bool clutch, double dt) {
    if (layout.mover->sensing == Sensing::velocity) {
        if (s.mover.usable && s.mover.silence < velocity_timeout && !clutch)
            integrate_velocity(layout, setup, s, snapshot.sample, view, dt);
        return;
    }
    if (s.mover.fresh) {
        const bool jumped = has_jumped(*layout.mover, s.mover_pose, snapshot.sample.pose);
        s.mover_pose = snapshot.sample.pose;
        // The tool stays in place and follows the device from there.
        if (snapshot.connection_number != s.mover.connection_number || jumped) {
            force::realign(layout.workspace, s.workspace, s.mover_pose, s.workspace.commanded_tool);
            s.workspace.force_share = s.mover.force_share = 0.0;
        }
        s.mover.connection_number = snapshot.connection_number;
    }
    if (s.mover.number == 0) return;
    const bool away = clutch || !s.mover.usable;
    set_heading_and_lever_arm(layout, s, heading_of(view), s.workspace.lever_arm);
    const Pose last = s.workspace.commanded_tool;
    force::to_assembly(layout.workspace, s.workspace, s.mover_pose, away, dt);
    if (!away) pivot_about_bolt(layout, setup, s, last, dt);
}

// Moves the tool; it follows the hand from there.
void place_tool(const DeviceLayout& layout, StationState& s, const Pose& tool) {
    force::realign(layout.workspace, s.workspace, s.mover_pose, tool);
}

// +1 if the wheel's angle counts counter-clockwise as the user sees it, −1 otherwise. The user looks at the
// wheel along −z or from above, and at a nut from the side to which the bolt's axis points.
double rotation_sense(const Description& wheel) {
    return glm::dot(wheel.axis, Vec3(0.0, 1.0, 1.0)) < 0.0 ? -1.0 : 1.0;
}

void turn_by_wheel(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                   const DeviceSnapshot& snapshot, bool clutch) {
    if (!s.wheel.fresh) return;
    const double by =
        snapshot.connection_number == s.wheel.connection_number ? snapshot.sample.angle - s.wheel_angle : 0.0;
    s.wheel.connection_number = snapshot.connection_number;
    s.wheel_angle = snapshot.sample.angle;
    if (!on_bolt(s) || clutch || by == 0.0 || !std::isfinite(by)) return;
    const servo::NutGeometry& nut = setup.nuts[static_cast<std::size_t>(s.output.joint)];
    const Vec3 centre = servo::nut_centre(nut, s.output.nut_angle);
    const Quat turned = glm::angleAxis(rotation_sense(*layout.wheel) * by, nut.axis);
    Pose tool = s.workspace.commanded_tool;
    tool.position = centre + turned * (tool.position - centre);
    tool.orientation = glm::normalize(turned * tool.orientation);
    place_tool(layout, s, tool);
}

// A wrench that is taken starts at its rest pose. A wrench released on a nut stays there; released elsewhere
// it returns to StationControls::wrench_rest_pose.
void update_resting_wrench(const DeviceLayout& layout, StationState& s, servo::Grip grip,
                           const StationControls& controls) {
    const std::optional<Pose>& rest = controls.wrench_rest_pose;
    if (!rest) return;
    const bool had = s.input.grip == servo::Grip::wrench, has = grip == servo::Grip::wrench;
    if (has && !had && s.resting_wrench) {
        place_tool(layout, s, *s.resting_wrench);
        s.workspace.force_share = 0.0;
    }
    if (has) s.resting_wrench.reset();
    // The hand stays in place; from now on the device moves its fingertips.
    if (had && !has && layout.wrist && controls.empty_hand_wrist)
        place_tool(layout, s,
                   s.workspace.commanded_tool * *layout.wrist * inverse(*controls.empty_hand_wrist));
    if (!has && !s.resting_wrench)
        s.resting_wrench = had && s.output.joint >= 0 ? s.output.constrained_tool : *rest;
}

void update_gripper(Gripper& gripper, double opening) {
    gripper.opening = opening;
    gripper.closed = opening < (gripper.closed ? gripper_opens_above : gripper_closes_below);
}

// Updates the links. Returns the controls combined with the devices' buttons.
StationControls merge_buttons(const DeviceLayout& layout, StationState& s, const StationInputs& inputs,
                              double elapsed) {
    StationControls controls = inputs.controls;
    controls.dead_man &= inputs.controls_age <= controls.dead_man_timeout;
    controls.stop |= std::exchange(s.stopped_in_pause, false);
    s.dead_man_pressed = false;
    const auto press = [&](const DeviceLink& link, const DeviceSnapshot& snapshot, const Buttons& buttons) {
        if (!link.usable) return;
        s.dead_man_pressed |= (snapshot.sample.buttons & buttons.dead_man) != 0;
        controls.clutch |= (snapshot.sample.buttons & buttons.clutch) != 0;
        controls.stop |= (snapshot.sample.buttons & buttons.stop) != 0;
        controls.reset |= (snapshot.sample.buttons & buttons.reset) != 0;
    };
    if (layout.mover) {
        update_link(*layout.mover, s.mover, inputs.mover, elapsed);
        press(s.mover, inputs.mover, layout.mover_buttons);
        if (layout.mover->senses_gripper && s.mover.usable) {
            update_gripper(s.gripper, inputs.mover.sample.gripper);
            s.dead_man_pressed |= s.gripper.closed;
        }
    }
    if (layout.wheel) {
        update_link(*layout.wheel, s.wheel, inputs.wheel, elapsed);
        press(s.wheel, inputs.wheel, layout.wheel_buttons);
    }
    controls.dead_man |= s.dead_man_pressed;
    return controls;
}

servo::Grip grip_of(const StationInputs& inputs) {
    if (!inputs.hand_grip) return inputs.controls.grip;
    if (*inputs.hand_grip == servo::Grip::wrench) return servo::Grip::wrench;
    return inputs.controls.grip == servo::Grip::fingers ? servo::Grip::fingers : servo::Grip::none;
}

// Queues the received commands in the state until a tick executes them.
void receive(StationState& s, std::span<const StationCommand> commands) {
    for (const StationCommand& command : commands) {
        if (const auto* place = std::get_if<PlaceTool>(&command)) s.tool_to_place = place->tool;
        if (std::holds_alternative<SaveCheckpoint>(command)) ++s.checkpoints_to_save;
        const auto* restore = std::get_if<RestoreCheckpoint>(&command);
        if (restore != nullptr && restore->steps <= servo::max_checkpoints)
            s.checkpoint_to_restore = restore->steps;
        const auto* amend = std::get_if<AmendRestore>(&command);
        if (amend != nullptr && amend->steps <= servo::max_checkpoints && s.checkpoint_to_restore != 0)
            s.checkpoint_to_restore = amend->steps;
    }
}

// The servo's checkpoint action of this tick. A restore stays pending until map_output() sees it done.
std::uint8_t next_checkpoint_action(StationState& s) {
    if (s.checkpoints_to_save == 0) return s.checkpoint_to_restore;
    --s.checkpoints_to_save;
    return servo::save_checkpoint;
}

force::OutputCommand part(const force::OutputCommand& whole, double share) {
    return {share * whole.force, share * whole.torque};
}

}  // namespace

StationState initial_state(const DeviceLayout& layout) {
    StationState state;
    state.workspace = force::align_workspace(layout.workspace, {}, layout.home);
    state.output.constrained_tool = layout.home;
    return state;
}

servo::TickInput read_inputs(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                             const StationInputs& inputs) {
    const double elapsed = setup.dt * (1.0 + static_cast<double>(inputs.missed));
    const StationControls controls = merge_buttons(layout, s, inputs, elapsed);
    receive(s, inputs.commands);
    if (layout.mover) move_by_mover(layout, setup, s, inputs.mover, controls.view, controls.clutch, elapsed);
    if (layout.wheel) turn_by_wheel(layout, setup, s, inputs.wheel, controls.clutch);
    if (s.tool_to_place) {
        place_tool(layout, s, *s.tool_to_place);
        s.tool_to_place.reset();
        s.workspace.force_share = 0.0;
    }
    const servo::Grip grip = grip_of(inputs);
    set_heading_and_lever_arm(
        layout, s, s.workspace.heading,
        grip == servo::Grip::wrench ? lever_arm_of(layout, setup.wrench.handle_length) : 0.0);
    update_resting_wrench(layout, s, grip, controls);

    servo::TickInput input;
    input.commanded_tool = servo::to_commanded_tool(s.workspace.commanded_tool);
    input.grip = grip;
    input.checkpoint_action = next_checkpoint_action(s);
    input.set_torque = controls.set_torque;

    input.dead_man = controls.dead_man;
    input.guided_joint = controls.guided_joint;
    input.tool = controls.tool;
    input.second_wrench = controls.second_wrench;
    input.stop = controls.stop;
    input.reset = controls.reset;
    input.missed = static_cast<std::uint8_t>(std::min<std::uint64_t>(inputs.missed, 15));
    // The device that renders the force must have sent a sample.
    const bool by_wheel = layout.wheel && (on_bolt(s) || !layout.mover);
    input.fresh =
        by_wheel ? has_current_data(*layout.wheel, s.wheel) : has_current_data(*layout.mover, s.mover);
    // During a stall the devices' own watchdogs released the force. The output stage must release it too and
    // ramp up.
    s.restarting = s.restarting || elapsed > servo_stall;
    if (s.restarting) input.fresh = false;
    s.input = input;
    return input;
}

DeviceCommands map_output(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                          const servo::Output& output) {
    if (output.undone > 0) s.checkpoint_to_restore = 0;
    s.output = output;
    DeviceCommands commands;
    if (s.restarting) {
        s.restarting = output.force != Vec3(0.0) || output.torque != Vec3(0.0);
        s.mover.force_share = s.wheel.force_share = 0.0;
    }
    force::OutputCommand felt{output.force, output.torque};
    if (layout.wheel) {
        const bool engaged = on_bolt(s);
        if (engaged) s.bolt_axis = setup.nuts[static_cast<std::size_t>(output.joint)].axis;
        s.wheel_fade =
            std::clamp(s.wheel_fade + (engaged ? setup.dt : -setup.dt) / wheel_fade_time, 0.0, 1.0);
        const double torque = glm::dot(felt.torque, s.bolt_axis) * s.wheel_fade * s.wheel.force_share;
        commands.wheel.torque = rotation_sense(*layout.wheel) * torque * layout.wheel->axis;
        felt.torque = Vec3(0.0);
    }
    if (layout.mover)
        commands.mover = part(force::to_device(layout.workspace, s.workspace, felt), s.mover.force_share);
    return commands;
}

DeviceCommands tick(const DeviceLayout& layout, servo::Setup& setup, StationState& state, servo::State& servo,
                    const StationInputs& inputs) {
    servo::TickInput input = read_inputs(layout, setup, state, inputs);
    move_to_nut(layout, setup, state, servo, inputs, input);
    servo::change_tool(setup, servo, input);
    return map_output(layout, setup, state, servo::tick(setup, servo, input));
}

Pose tool_of_gloved_hand(const DeviceLayout& layout, const servo::Setup& setup, const StationState& s,
                         const StationControls& controls) {
    const bool hand_is_empty = s.resting_wrench && layout.wrist && controls.empty_hand_wrist;
    if (hand_is_empty) {
        const Vec3 tip = inverse(*s.resting_wrench) * s.workspace.commanded_tool.position;
        const Vec3 nearest(std::clamp(tip.x, 0.0, setup.wrench.handle_length), 0.0, 0.0);
        if (glm::distance(tip, nearest) < handle_capture_distance) return *s.resting_wrench;
    }
    return hand_is_empty ? s.workspace.commanded_tool * *controls.empty_hand_wrist * inverse(*layout.wrist)
                         : s.workspace.commanded_tool;
}

DeviceCommands pause_tick(const DeviceLayout& layout, const servo::Setup& setup, StationState& s,
                          const StationInputs& inputs) {
    const double elapsed = setup.dt * (1.0 + static_cast<double>(inputs.missed));
    receive(s, inputs.commands);
    s.stopped_in_pause = merge_buttons(layout, s, inputs, elapsed).stop;
    if (layout.mover) move_by_mover(layout, setup, s, inputs.mover, inputs.controls.view, true, elapsed);
    if (layout.wheel) {
        // A reopened wheel may send its first sample after the pause; turn_by_wheel() must then detect the
        // new connection.
        if (s.wheel.fresh) {
            s.wheel_angle = inputs.wheel.sample.angle;
            s.wheel.connection_number = inputs.wheel.connection_number;
        }
    }
    s.restarting = true;
    s.wheel_fade = s.mover.force_share = s.wheel.force_share = 0.0;
    return {};
}

StationStep step(const DeviceLayout& layout, servo::Setup& setup, StationState& s, servo::State& servo,
                 const StationInputs& inputs, std::uint64_t number) {
    StationStep done;
    done.paused = inputs.controls.pause;
    done.commands =
        done.paused ? pause_tick(layout, setup, s, inputs) : tick(layout, setup, s, servo, inputs);
    done.tick.number = number;
    done.tick.input = s.input;
    done.tick.output = s.output;
    done.tick.commanded_tool = s.workspace.commanded_tool;
    done.tick.mover_in_assembly = force::device_in_assembly(layout.workspace, s.workspace);
    if (layout.mover && layout.mover->sensing == Sensing::pose && s.mover.usable)
        done.tick.mover = MoverSample{s.mover_pose, inputs.mover.sample.buttons};
    done.tick.resting_wrench = s.resting_wrench;
    done.tick.dead_man_pressed = s.dead_man_pressed;
    done.tick.gripper = s.gripper;
    return done;
}

}  // namespace bolt::station
