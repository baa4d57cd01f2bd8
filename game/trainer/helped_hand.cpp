#include "game/trainer/helped_hand.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "game/motion/path_planning.hpp"

namespace bolt::trainer {

namespace {

using motion::arc_pose;
using motion::minimum_jerk;

constexpr double max_hover = 0.045;        // m above a nut; clears the end of the bolt
constexpr double retreat_distance = 0.15;  // m, up from the resting place and towards the trainee
constexpr double hand_speed = 0.45;        // m/s, mean speed of a reach; the peak is about twice that
constexpr double min_reach_time = 0.25;    // s
constexpr double lowering_time = 0.35, lifting_time = 0.25;  // s
constexpr double engage_timeout = 0.6;                       // s on the nut without engaging it
// m between nut and wrench beyond which an obstacle has stopped the wrench.
constexpr double caught_distance = 0.05;
constexpr double miss_height = 0.05;                   // m of additional height per miss
constexpr double ease_time = 0.15;                     // s
constexpr double twist_range = to_radians(200.0);      // range of the fingers, before they return
constexpr double twist_speed = to_radians(540.0);      // rad/s, maximum
constexpr double return_time = 0.15;                   // s
constexpr double preferred_stroke = to_radians(60.0);  // preferred room for a pull
constexpr double max_pull_speed = to_radians(150.0);   // rad/s
// Conveys effort: at the greatest torque a drag turns the handle by only 1/(1 + this) of its angle.
constexpr double drag_resistance = 2.0;

const servo::NutGeometry& nut_of(const HelpedHand& hand, const servo::Setup& setup) {
    return setup.nuts[hand.nut.value()];
}

Pose at_nut(const HelpedHand& hand, const servo::Setup& setup, const servo::State& state, double above) {
    const servo::NutGeometry& nut = nut_of(hand, setup);
    const double angle = state.joints[hand.nut.value()].nut.angle;
    return {servo::nut_centre(nut, angle) + above * nut.axis,
            motion::tool_orientation(nut, hand.handle_angle, hand.flipped)};
}

bool engaged(const HelpedHand& hand, const servo::State& state) {
    return hand.nut && state.engagement.joint == static_cast<int>(*hand.nut);
}

void start_movement(HelpedHand& hand, const Pose& to, double seconds, HandAction action) {
    hand.from = hand.pose;
    hand.to = to;
    hand.bulge = Vec3(0.0);
    hand.elapsed = 0.0;
    hand.duration = seconds;
    hand.action = action;
}

double reach_time(const Pose& from, const Pose& to, const Vec3& bulge) {
    const double path = glm::distance(from.position, to.position) + 2.0 * glm::length(bulge);
    const double rotation = glm::length(turn_between(from.orientation, to.orientation));
    return std::max({min_reach_time, path / hand_speed, rotation / 4.0});
}

// Starts a reach. The wrench follows a path free of visible obstacles; an empty hand does not collide.
void reach(HelpedHand& hand, const Pose& to, HelpedHand::OnArrival on_arrival, const servo::Setup& setup,
           const servo::State& state, const Vec3& up) {
    const double distance = glm::distance(hand.pose.position, to.position);
    motion::ReachPath path{(std::min(0.05, 0.3 * distance) + miss_height * std::min(hand.misses, 5)) * up,
                           {}};
    if (hand.wrench && state.tool_contact)
        path = motion::plan_reach(setup, *state.tool_contact, hand.pose, to, up, glm::length(path.bulge));
    hand.waypoints.assign(1, to);
    hand.waypoints.insert(hand.waypoints.end(), path.waypoints.rbegin(), path.waypoints.rend());
    const Pose first = hand.waypoints.back();
    hand.waypoints.pop_back();
    start_movement(hand, first, reach_time(hand.pose, first, path.bulge), HandAction::reaching);
    hand.bulge = path.bulge;
    hand.on_arrival = on_arrival;
}

// Chooses the side from which the handle approaches the nut.
void choose_side(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    const double sign = hand.loosens ? -1.0 : 1.0;
    const servo::NutGeometry& nut = nut_of(hand, setup);
    // The handle points towards the trainee in the middle of the pull. From the second miss on it is turned
    // to either side in turn, by 60° more at each second miss.
    const Vec3 to_trainee = hand.rest.position - nut.seat;
    const double aside = (hand.misses % 2 == 1 ? 1.0 : -1.0) * to_radians(60.0) * (hand.misses / 2);
    const double wanted = servo::angle_of(nut, to_trainee) - 0.5 * sign * preferred_stroke + aside;
    const auto handle =
        motion::choose_handle_angle(setup, state.tool_contact ? &*state.tool_contact : nullptr, *hand.nut,
                                    state.joints[*hand.nut], wanted, sign, preferred_stroke);
    hand.handle_angle = handle.angle;
    hand.flipped = handle.flipped;
    hand.free_swing = handle.free_swing;
    hand.hover_height = state.tool_contact
                            ? motion::hover_height(setup, *state.tool_contact, *hand.nut,
                                                   state.joints[*hand.nut].nut.angle, handle, max_hover)
                            : max_hover;
}

void go_to_nut(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.turn = 0.0;
    hand.missed = false;
    if (hand.wrench) {
        choose_side(hand, setup, state);
    } else {
        hand.flipped = false;
        hand.handle_angle = 0.0;
        hand.hover_height = max_hover;
    }
    reach(hand, at_nut(hand, setup, state, hand.hover_height), HelpedHand::OnArrival::lower, setup, state,
          nut_of(hand, setup).axis);
}

// Goes to the nut of the hand. If the wrench in the hand does not turn it, changes the tool first.
void start_for_nut(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.changes_tool = false;
    const servo::NutGeometry& nut = nut_of(hand, setup);
    if (hand.wrench && nut.tool != setup.tool)
        reach(hand, hand.rest, HelpedHand::OnArrival::change_tool, setup, state, nut.axis);
    else
        go_to_nut(hand, setup, state);
}

void lift(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.pose = hand.wrench && state.tool_contact && state.tool_contact->in_hand
                    ? state.tool_contact->god_object.constrained_tool
                    : hand.pose;
    Pose up = at_nut(hand, setup, state, hand.hover_height);
    up.orientation = hand.pose.orientation;
    // An obstacle stopped the wrench on its way: move up from there, not through the obstacle.
    const servo::NutGeometry& nut = nut_of(hand, setup);
    if (hand.missed && glm::distance(hand.pose.position, nut.seat) > caught_distance)
        up.position = hand.pose.position + max_hover * nut.axis;
    start_movement(hand, up, lifting_time, HandAction::lifting);
}

// Moves the hand towards the trainee, with whatever it holds.
void withdraw(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.nut.reset();
    hand.changes_tool = false;
    const Vec3 up = setup.nuts.empty() ? Vec3(0, 1, 0) : setup.nuts.front().axis;
    const Vec3 near_trainee = hand.rest * Vec3(0.0, hand.trainee_side * retreat_distance, 0.0);
    reach(hand, {near_trainee + retreat_distance * up, hand.rest.orientation}, HelpedHand::OnArrival::rest,
          setup, state, up);
}

void arrive(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    if (!hand.waypoints.empty()) {
        const Pose next = hand.waypoints.back();
        hand.waypoints.pop_back();
        start_movement(hand, next, reach_time(hand.pose, next, Vec3(0.0)), HandAction::reaching);
        return;
    }
    hand.action = HandAction::resting;
    switch (hand.on_arrival) {
        case HelpedHand::OnArrival::rest:
            break;
        case HelpedHand::OnArrival::take:
            hand.wrench = true;
            break;
        case HelpedHand::OnArrival::lay_down:
            hand.wrench = false;
            break;
        case HelpedHand::OnArrival::change_tool:
            hand.wrench = false;
            hand.tool = static_cast<std::uint8_t>(nut_of(hand, setup).tool);
            hand.changes_tool = true;
            break;
        case HelpedHand::OnArrival::lower:
            if (hand.button_down)
                start_movement(hand, at_nut(hand, setup, state, 0.0), lowering_time, HandAction::lowering);
            break;
    }
}

// Turns the handle by the pending drag, limited by the speed of an arm and the room to swing.
void pull(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    const double torque = std::abs(state.joints[*hand.nut].torque), dt = setup.dt;
    const double greatest = setup.wrench.stiffness * to_radians(2.5);
    const double gain = 1.0 / (1.0 + drag_resistance * torque / greatest);
    const double step = std::clamp(gain * hand.turn, -max_pull_speed * dt, max_pull_speed * dt);
    hand.turn -= step / gain;
    const double least = hand.stroke_begin - (hand.loosens ? hand.free_swing : preferred_stroke);
    const double most = hand.stroke_begin + (hand.loosens ? preferred_stroke : hand.free_swing);
    const double to = std::clamp(hand.handle_angle + step, least, most);
    if (to != hand.handle_angle + step) hand.turn = 0.0;  // no swing left: discard the rest of the drag
    hand.handle_angle = to;
}

void spin(HelpedHand& hand, const servo::Setup& setup) {
    hand.handle_angle += twist_speed * hand.spin * setup.dt;
    if (std::abs(hand.handle_angle - hand.stroke_begin) < twist_range) return;
    hand.action = HandAction::returning;
    hand.elapsed = 0.0;
    hand.duration = return_time;
    hand.twist_end = hand.handle_angle;
}

void hold(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    const bool on = engaged(hand, state);
    if (!on) hand.stroke_begin = hand.handle_angle;
    hand.elapsed = on ? 0.0 : hand.elapsed + setup.dt;
    if (!hand.button_down) {
        if (hand.wrench && on) {
            hand.action = HandAction::easing;
            hand.elapsed = 0.0;
        } else {
            lift(hand, setup, state);
        }
        return;
    }
    if (hand.elapsed > engage_timeout) {  // slipped off, or never engaged
        hand.missed = true;
        ++hand.misses;
        hand.button_down = false;
        lift(hand, setup, state);
        return;
    }
    if (!on) return;
    hand.missed = false;
    hand.misses = 0;
    if (hand.wrench)
        pull(hand, setup, state);
    else
        spin(hand, setup);
}

// Lets the wrench spring back until it transmits no torque.
void ease(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    hand.elapsed += setup.dt;
    hand.handle_angle -= state.joints[*hand.nut].torque / setup.wrench.stiffness *
                         std::min(1.0, setup.dt / 0.03) * std::min(1.0, hand.elapsed / 0.03);
    if (hand.elapsed > ease_time) lift(hand, setup, state);
}

void travel(HelpedHand& hand, double dt) {
    hand.elapsed += dt;
    const double done = hand.duration > 0.0 ? hand.elapsed / hand.duration : 1.0;
    hand.pose = arc_pose(hand.from, hand.to, minimum_jerk(done), hand.bulge);
}

}  // namespace

HelpedHand make_hand(const Pose& rest, hand::Side side) {
    HelpedHand hand;
    hand.rest = rest;
    hand.trainee_side = side == hand::Side::left ? 1.0 : -1.0;
    // Beside the handle and slightly above it.
    hand.pose = {rest * Vec3(0.16, 0.05 * hand.trainee_side, 0.06), rest.orientation};
    return hand;
}

WorkingHand hand_of(const HelpedHand& mouse) {
    WorkingHand hand;
    hand.action = mouse.action;
    hand.wrench = mouse.wrench;
    hand.nut = mouse.nut;
    hand.pose = mouse.pose;
    hand.to = mouse.waypoints.empty() ? mouse.to : mouse.waypoints.front();
    hand.rest = mouse.rest;
    const bool has = mouse.action == HandAction::holding || mouse.action == HandAction::returning;
    const double turned = has ? mouse.handle_angle - mouse.stroke_begin : 0.0;
    if (mouse.wrench)
        hand.free_swing = mouse.free_swing - std::abs(turned);
    else
        hand.twisted = turned;
    return hand;
}

void apply_command(HelpedHand& hand, const MouseCommand& command, const servo::Setup& setup,
                   const servo::State& state) {
    hand.button_down = command.button_down;
    hand.spin = std::clamp(command.spin, -1.0, 1.0);
    if (hand.action == HandAction::holding) hand.turn += command.turn;
    const bool free = hand.action == HandAction::resting || hand.action == HandAction::reaching;
    hand.queued_nut = free || !command.button_down ? std::nullopt
                      : command.nut                ? command.nut
                                                   : hand.queued_nut;
    if (!free) return;
    if (!hand.wrench && !hand.changes_tool) hand.tool = command.tool;
    const Vec3 up = setup.nuts.empty() ? Vec3(0, 1, 0) : setup.nuts.front().axis;
    if (command.retreat) {
        withdraw(hand, setup, state);
    } else if (command.take_wrench && !hand.wrench) {
        hand.nut.reset();
        reach(hand, hand.rest, HelpedHand::OnArrival::take, setup, state, up);
    } else if (command.lay_down && hand.wrench) {
        hand.nut.reset();
        reach(hand, hand.rest, HelpedHand::OnArrival::lay_down, setup, state, up);
    } else if (command.nut && *command.nut < setup.nuts.size()) {
        hand.nut = command.nut;
        hand.loosens = command.loosens;
        start_for_nut(hand, setup, state);
    }
}

Pose wrench_pose_on_nut(const Pose& rest, const servo::Setup& setup, const servo::State& state,
                        std::size_t joint, bool loosens) {
    HelpedHand other = make_hand(rest);
    other.nut = joint;
    other.loosens = loosens;
    choose_side(other, setup, state);
    return at_nut(other, setup, state, 0.0);
}

servo::TickInput step_hand(HelpedHand& hand, const servo::Setup& setup, const servo::State& state) {
    if (hand.changes_tool && setup.tool == hand.tool && hand.nut) {
        hand.changes_tool = false;
        hand.wrench = true;
        go_to_nut(hand, setup, state);
    }
    servo::Grip grip = hand.wrench ? servo::Grip::wrench : servo::Grip::none;
    switch (hand.action) {
        case HandAction::resting:
            break;
        case HandAction::reaching:
            travel(hand, setup.dt);
            if (hand.elapsed >= hand.duration) arrive(hand, setup, state);
            break;
        case HandAction::lowering:
            travel(hand, setup.dt);
            if (hand.elapsed < hand.duration) break;
            hand.action = HandAction::holding;
            hand.elapsed = hand.turn = 0.0;
            hand.stroke_begin = hand.handle_angle;
            break;
        case HandAction::holding:
            hold(hand, setup, state);
            if (hand.action == HandAction::holding) hand.pose = at_nut(hand, setup, state, 0.0);
            if (!hand.wrench && hand.action == HandAction::holding) grip = servo::Grip::fingers;
            break;
        case HandAction::returning:
            hand.elapsed += setup.dt;
            hand.handle_angle = hand.twist_end + (hand.stroke_begin - hand.twist_end) *
                                                     minimum_jerk(hand.elapsed / hand.duration);
            hand.pose = at_nut(hand, setup, state, 0.0);
            if (hand.elapsed < hand.duration) break;
            hand.action = HandAction::holding;
            hand.elapsed = 0.0;
            hand.stroke_begin = hand.handle_angle;
            break;
        case HandAction::easing:
            ease(hand, setup, state);
            if (hand.action == HandAction::easing) hand.pose = at_nut(hand, setup, state, 0.0);
            break;
        case HandAction::lifting:
            travel(hand, setup.dt);
            if (hand.elapsed < hand.duration) break;
            hand.action = HandAction::resting;
            // After repeated misses return to the resting place, from which all nuts can be reached.
            if (hand.missed && hand.misses > 2 && hand.wrench && state.tool_contact) {
                withdraw(hand, setup, state);
                break;
            }
            if (hand.queued_nut && hand.button_down) {
                hand.nut = std::exchange(hand.queued_nut, std::nullopt);
                start_for_nut(hand, setup, state);
            }
            break;
    }
    servo::TickInput input;
    input.dead_man = true;
    input.grip = grip;
    input.tool = hand.tool;
    input.commanded_tool = servo::to_commanded_tool(hand.pose);
    return input;
}

}  // namespace bolt::trainer
