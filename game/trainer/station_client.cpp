#include "game/trainer/station_client.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "game/lesson/step_requirements.hpp"

namespace bolt::trainer {

namespace {

using platform::Key;

struct KeyMotion {
    Key key;
    Vec3 along, about;
};
const KeyMotion key_motions[] = {
    {Key::d, Vec3(1, 0, 0), Vec3(0.0)},       {Key::a, Vec3(-1, 0, 0), Vec3(0.0)},
    {Key::e, Vec3(0, 1, 0), Vec3(0.0)},       {Key::q, Vec3(0, -1, 0), Vec3(0.0)},
    {Key::s, Vec3(0, 0, 1), Vec3(0.0)},       {Key::w, Vec3(0, 0, -1), Vec3(0.0)},
    {Key::left, Vec3(0.0), Vec3(0, 1, 0)},    {Key::right, Vec3(0.0), Vec3(0, -1, 0)},
    {Key::up, Vec3(0.0), Vec3(-1, 0, 0)},     {Key::down, Vec3(0.0), Vec3(1, 0, 0)},
    {Key::page_up, Vec3(0.0), Vec3(0, 0, 1)}, {Key::page_down, Vec3(0.0), Vec3(0, 0, -1)},
};
// Rate of a pressed key relative to a fully deflected puck. It must exceed the attraction to a nut, or the
// tool could not leave the nut.
constexpr double key_rate = 0.75;

}  // namespace

void KeyboardPuck::handle_events(std::span<const platform::InputEvent> events) {
    for (const platform::InputEvent& event : events) {
        if (const auto* key = std::get_if<platform::KeyEvent>(&event))
            down_.set(static_cast<std::size_t>(key->key), key->down);
        else if (const auto* focus = std::get_if<platform::FocusEvent>(&event);
                 focus != nullptr && !focus->focused)
            down_.reset();
    }
}

device::PuckInput KeyboardPuck::input() const {
    device::PuckInput input;
    for (const KeyMotion& motion : key_motions) {
        if (!down_.test(static_cast<std::size_t>(motion.key))) continue;
        input.along += key_rate * motion.along;
        input.about += key_rate * motion.about;
    }
    input.buttons = button_down() ? 1 : 0;
    return input;
}

bool KeyboardPuck::button_down() const { return down_.test(static_cast<std::size_t>(Key::space)); }
bool KeyboardPuck::shift_down() const { return down_.test(static_cast<std::size_t>(Key::shift)); }

namespace {

// s without a frame after which the dead-man switch counts as released.
constexpr double dead_man_timeout = 0.5;
constexpr double nut_capture_distance = 0.06;  // m
constexpr double nut_release_distance = 0.08;  // m; larger than nut_capture_distance, as hysteresis
// m from a nut within which the nut attracts the tool if the lesson does not guide to a joint.
constexpr double attraction_range = 0.06;

double distance_to_handle(const Vec3& point, const Pose& wrench, double length) {
    const Vec3 local = inverse(wrench) * point;
    return glm::distance(local, Vec3(std::clamp(local.x, 0.0, length), 0.0, 0.0));
}

Vec3 nut_at(const session::LessonSession& session, std::size_t joint) {
    return servo::nut_centre(session.setup().nuts[joint], session.state().joints[joint].nut.angle);
}

std::optional<std::size_t> nearest_nut(const session::LessonSession& session, const Vec3& tool,
                                       double within) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < session.setup().nuts.size(); ++i) {
        const double distance = glm::distance(nut_at(session, i), tool);
        if (distance >= within) continue;
        within = distance;
        nearest = i;
    }
    return nearest;
}

bool pinches(const hand::Skeleton& hand) {
    return glm::distance(hand.position[hand::thumb_tip], hand.position[hand::index_tip]) < pinch_distance;
}

// Grip of a hand without a glove, or of the fingers of a gloved hand; the station determines when a gloved
// hand holds the wrench.
servo::Grip grip_of(const StationClient& client, bool closes, const UserActions& actions) {
    const bool has_wrench =
        (client.gloved ? client.latest.input.grip : client.controls.grip) == servo::Grip::wrench;
    const bool engaged = client.latest.output.joint >= 0;
    if (has_wrench && !client.gloved && client.has_gripper && !closes) return servo::Grip::none;
    if (has_wrench && !client.gloved)
        return actions.toggle_wrench && !engaged ? servo::Grip::none : servo::Grip::wrench;
    if (has_wrench) return servo::Grip::none;
    const bool takes = (closes && !client.hand_closed && !client.nut_is_nearer) || actions.toggle_wrench;
    if (!client.gloved && takes && client.near_wrench && !engaged) return servo::Grip::wrench;
    return closes && client.near_nut ? servo::Grip::fingers : servo::Grip::none;
}

void update_client(StationClient& client, const session::LessonSession& session) {
    client.latest = client.link->latest_tick();
    client.fault_messages = client.link->fault_messages();
    if (!client.wrist_fault.empty()) client.fault_messages.push_back(client.wrist_fault);
    client.needs = client.link->needs();
    client.health = client.link->health();
    const station::DisplayedHand* hand = client.link->hand();
    client.gloved = hand != nullptr;
    client.has_gripper = client.link->layout().mover && client.link->layout().mover->senses_gripper;
    client.glove_lost = hand != nullptr && hand->lost;
    if (hand != nullptr && hand->has_angles) client.fingers = hand->finger_joints;
    const double within = client.near_nut ? nut_release_distance : nut_capture_distance;
    client.near_nut = nearest_nut(session, client.latest.output.constrained_tool.position, within);
    const Vec3& hand_at = client.latest.commanded_tool.position;
    const std::optional<Pose>& resting = client.latest.resting_wrench;
    const double to_wrench = resting
                                 ? distance_to_handle(hand_at, *resting, session.setup().wrench.handle_length)
                                 : std::numeric_limits<double>::infinity();
    client.near_wrench = to_wrench < station::handle_capture_distance;
    // A dragged hand closes on what the pointer is pressed on.
    client.nut_is_nearer = !client.dragged && client.near_nut &&
                           glm::distance(hand_at, nut_at(session, *client.near_nut)) < to_wrench;
}

// Sends one-time commands: checkpoints, undo, and the pose at which to place the tool.
Status send_commands(StationClient& client, const session::LessonSession& session,
                     const UserActions& actions) {
    for (; client.checkpoints_sent < session.target_checkpoints(); ++client.checkpoints_sent)
        BOLT_TRY(client.link->send(station::SaveCheckpoint{}));
    const bool engaged = client.latest.output.joint >= 0;
    const std::uint8_t back =
        actions.undo && !engaged ? session.restore_action(*actions.undo) : std::uint8_t{0};
    if (back != client.restore_sent) {
        if (client.restore_sent == 0)
            BOLT_TRY(client.link->send(station::RestoreCheckpoint{back}));
        else
            BOLT_TRY(client.link->send(station::AmendRestore{back}));
        client.restore_sent = back;
    }
    if (client.tool_placed && (engaged || !actions.recentre)) return {};
    if (client.tracked && !client.tracked->present) return {};
    client.tool_placed = true;
    return client.link->send(station::PlaceTool{client.tracked ? client.tracked->fingertips : client.home});
}

}  // namespace

WorkingHand hand_of(const StationClient& client) {
    const bool engaged = client.latest.output.joint >= 0;
    WorkingHand hand;
    hand.wrench = client.latest.input.grip == servo::Grip::wrench;
    hand.nut =
        engaged ? std::optional(static_cast<std::size_t>(client.latest.output.joint)) : client.near_nut;
    hand.action = engaged ? HandAction::holding : hand.nut ? HandAction::lowering : HandAction::resting;
    hand.pose = hand.to = client.latest.commanded_tool;
    hand.rest = client.latest.resting_wrench.value_or(client.rest);
    if (client.tracked && client.tracked->motion.target)
        hand.palm = hand.pose * palm_joint_at_fingertips(client.tracked->side);
    if (client.has_gripper) hand.closed_share = 1.0 - client.latest.gripper.opening;
    if (client.gloved && engaged && client.latest.input.grip == servo::Grip::fingers)
        hand.free_swing = std::max(
            0.0, forearm_range - std::abs(client.latest.output.nut_angle - client.nut_angle_at_grip));
    return hand;
}

void give_hand_to_mouse(StationClient& client) {
    client.tracked.reset();
    client.dragged.emplace();
    client.link->change_arm(device::simulated_arm_description(), false);
}

void give_hand_to_headset(StationClient& client, xr::Side side) {
    client.dragged.reset();
    client.tracked.emplace().side = side;
    client.tool_placed = false;
    client.link->change_arm(device::tracked_hand_description(), true);
}

bool needs_dead_man(const station::DeviceLayout& layout) {
    const auto renders = [](const std::optional<device::Description>& d) {
        return d && (station::renders_force(*d) || station::renders_torque(*d));
    };
    return renders(layout.mover) || renders(layout.wheel);
}

Status send_actions(StationClient& client, const session::LessonSession& session,
                    const UserActions& actions) {
    update_client(client, session);
    client.link->set_puck_input(client.keyboard.input());
    if (client.dragged) client.link->set_hand_motion(client.dragged->motion);
    if (client.tracked) {
        client.link->set_hand_motion(client.tracked->motion);
        // A hand that has released the wrench may have another orientation than the tool: place the tool.
        const bool wrench = client.latest.input.grip == servo::Grip::wrench;
        if (std::exchange(client.tracked->had_wrench, wrench) && !wrench) client.tool_placed = false;
    }
    station::StationControls& controls = client.controls;
    const bool held = client.gloved && client.latest.input.grip == servo::Grip::wrench;
    const bool closes = client.keyboard.button_down() || client.latest.dead_man_pressed ||
                        (client.gloved && !held && pinches(client.fingers));
    controls.pause = actions.paused;
    controls.wrench_rest_pose = client.rest;
    controls.empty_hand_wrist = client.empty_hand_wrist;
    controls.grip = grip_of(client, closes, actions);
    // A glove that sends no valid samples keeps the wrench, but releases the dead-man switch.
    const bool hand_closed = client.gloved && !client.glove_lost && (held || closes);
    controls.dead_man =
        !needs_dead_man(client.link->layout()) || hand_closed || client.keyboard.button_down();
    controls.dead_man_timeout = dead_man_timeout;
    controls.view = actions.view;
    const lesson::LessonStep* due = session.lesson().due();
    const bool guides_to_due = due != nullptr && session.lesson().guides;
    controls.guided_joint = guides_to_due ? static_cast<std::int16_t>(due->joint) : std::int16_t{-1};
    // A nut attracts the tool only while the hand is closed.
    const auto attracting_nut =
        guides_to_due
            ? std::optional(due->joint)
            : nearest_nut(session, client.latest.output.constrained_tool.position, attraction_range);
    controls.approach_joint =
        attracting_nut && closes ? static_cast<std::int16_t>(*attracting_nut) : std::int16_t{-1};
    controls.set_torque = static_cast<float>(lesson::wrench_set_torque(session.lesson()));
    controls.tool = session.due_tool();
    controls.second_wrench = actions.second_wrench;
    client.link->set_controls(controls);
    client.hand_closed = closes;
    return send_commands(client, session, actions);
}

lesson::ControlNames control_names(const words::Words& words, const KeyMap& keys, const Equipment& equipment,
                                   const StationClient* client) {
    if (client != nullptr && client->tracked) return lesson::tracked_controls(words);
    const std::string tool = key_name(keys, Action::tool);
    const auto with_second_wrench = [&](lesson::ControlNames names) {
        return lesson::with_second_wrench(words, std::move(names), key_name(keys, Action::second_wrench));
    };
    if (client == nullptr) return with_second_wrench(lesson::mouse_controls(words, tool));
    if (client->dragged) return with_second_wrench(lesson::drag_controls(words, tool));
    const station::DeviceLayout& layout = client->link->layout();
    const std::uint32_t held = layout.mover_buttons.dead_man;
    const bool keyboard = equipment.devices.empty();
    const std::string closes =
        keyboard || held == 0
            ? std::string(platform::name(platform::Key::space))
            : words::format_text(
                  words, "control.device.button",
                  {{"number", words::Number{static_cast<double>(std::countr_zero(held) + 1), 0}}});
    const bool feels = layout.mover && station::renders_force(*layout.mover);
    lesson::ControlNames names = keyboard ? lesson::keyboard_controls(words, closes, tool)
                                 : feels  ? lesson::device_controls(words, closes, tool)
                                          : lesson::puck_controls(words, closes, tool);
    const bool fingers = client->link->hand() != nullptr || (layout.mover && layout.mover->senses_gripper);
    return with_second_wrench(fingers ? lesson::glove_controls(words, std::move(names)) : std::move(names));
}

}  // namespace bolt::trainer
