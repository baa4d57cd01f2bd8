#include "game/trainees/behaviour.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "game/motion/path_planning.hpp"

namespace bolt::trainees {

namespace {

constexpr double flip_rise = 0.03;       // m that a wrench is lifted to be flipped beside its bolt
constexpr double max_arc_height = 0.05;  // m, of a reach between joints
// A wrench that lags behind the intended pose by caught_distance (m) for caught_delay (s) is caught.
constexpr double caught_distance = 0.02, caught_delay = 0.5;
constexpr double retreat = 0.06;  // m
constexpr int max_catches = 4;    // in a row, before the trainee begins again at the rest pose
constexpr int max_misses = 3, max_fruitless = 3;  // misses and strokes before the trainee tries another side
constexpr int max_lift = 4;                       // in steps of lift_step
constexpr double lift_step = 1e-3;                // m

// These values are chosen, not measured.
constexpr double second_wrench_time = 1.5;         // s in which it is put on
constexpr double noticed_turn = to_radians(30.0);  // of nut and bolt together
constexpr double glance = 0.3;                     // s
constexpr double head_speed = to_radians(60.0);    // rad/s
// The camera reaches a new view within five time constants of 70 ms (game/view/camera.hpp).
constexpr double view_transition = 0.35;  // s

Vec3 unit(const Vec3& v) { return v / (1e-3 + glm::length(v)); }

// The direction that leads a tool at `position` off the nearest nut. While the trainee goes to another joint,
// this is not the nut of its plan.
Vec3 way_off_nut(const TraineeState& t, const Vec3& position) {
    Vec3 up(0.0, 1.0, 0.0);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < t.setup->nuts.size(); ++i) {
        const servo::NutGeometry& nut = t.setup->nuts[i];
        const double distance =
            glm::distance(position, servo::nut_centre(nut, t.servo_state->joints[i].nut.angle));
        if (distance >= nearest) continue;
        nearest = distance;
        up = nut.axis;
    }
    return up;
}

// Plans the movement from t.from to t.to along an arc towards `up`. With obstacles it may insert waypoints
// before t.to.
void plan_path(TraineeState& t, const Vec3& up) {
    const Quat turn = glm::normalize(t.to.orientation * glm::conjugate(t.from.orientation));
    const double turn_share = glm::length(rotation_vector(turn)) / pi;
    const double rise =
        std::max(flip_rise * turn_share,
                 std::min(max_arc_height, 0.3 * glm::distance(t.from.position, t.to.position)));
    t.bulge = rise * up;
    t.waypoints.clear();
    if (t.obstacles() == nullptr) return;
    motion::ReachPath path = motion::plan_reach(*t.setup, *t.obstacles(), t.from, t.to, up,
                                                rise + 0.05 * std::min(t.consecutive_catches, 5));
    t.bulge = path.bulge;
    if (path.waypoints.empty()) return;
    t.waypoints.push_back(t.to);
    t.waypoints.insert(t.waypoints.end(), path.waypoints.rbegin(), path.waypoints.rend());
    t.to = t.waypoints.back();
    t.waypoints.pop_back();
}

// Sets t.next_eye to a position from which the nut is visible, and returns the time, s, that the search
// takes: 0 without obstacles or if the fingers do the step. If too little is visible the trainee first
// requests a view from the view help, if there is one. If that view shows too little as well, the trainee
// moves its head.
double search_view(TraineeState& t) {
    t.next_eye = t.visibility.eye;
    if (t.obstacles() == nullptr || t.plan.fingers) return 0.0;
    t.placement_error = Vec3(0.0);
    const Pose wrench = t.tool_at_nut(t.hover_height);
    const servo::ToolContact& contact = *t.obstacles();
    double seconds = 0.0;
    const auto sees_enough = [&] {
        return motion::target_visibility(t.visibility, *t.setup, contact, t.plan.joint, wrench,
                                         t.visibility.eye) >= t.profile.wanted_visibility;
    };
    if (t.view_help && !sees_enough()) {
        const Vec3 nut = servo::nut_centre(t.nut(), t.joint().nut.angle);
        t.visibility.eye = t.next_eye =
            t.view_help({*t.setup, contact, t.plan.joint, nut, wrench, t.visibility.eye});
        seconds = glance + view_transition;
    }
    const auto better = motion::improve_view(t.visibility, *t.setup, contact, t.plan.joint, wrench,
                                             t.profile.wanted_visibility, t.random);
    if (!better) return seconds;
    t.next_eye = better->eye;
    return seconds + better->glances * glance + better->turn / head_speed;
}

// Draws the offset of the placed tool from the nut's centre, m. It depends on what is visible from
// t.next_eye.
Vec3 random_placement_error(TraineeState& t) {
    if (t.plan.fingers) return t.random_offset(3.0 * t.profile.position_noise);
    const double seen = t.obstacles() == nullptr
                            ? 1.0
                            : motion::target_visibility(t.visibility, *t.setup, *t.obstacles(), t.plan.joint,
                                                        t.tool_at_nut(t.hover_height), t.next_eye);
    // An open end that touches something beside the nut can hardly turn it, so it is placed higher the next
    // time. Other heads are not: they are put on from above, and a key that is higher does not reach its
    // socket.
    const int steps = std::clamp(t.fruitless_strokes - max_fruitless, 0, max_lift);
    const Vec3 lift = reversible(t.setup->wrench) ? lift_step * steps * t.nut().axis : Vec3(0.0);
    return lift +
           t.random_offset(motion::placement_noise(t.profile.position_noise, seen, t.consecutive_misses));
}

// s. Grows with the distance from a minimum to a limit (after Fitts); with obstacles also with the detour.
double reach_duration(const TraineeState& t) {
    const double distance_factor = std::min(1.0, 0.35 + glm::distance(t.from.position, t.to.position) / 0.3);
    const double detour_factor = t.obstacles() != nullptr ? 1.0 + 2.0 * glm::length(t.bulge) : 1.0;
    return distance_factor * t.profile.reach_time * detour_factor;
}

// With obstacles the tool is changed at the rest pose, which is clear of them.
void go_to_rest(TraineeState& t) {
    t.to = t.rest;
    plan_path(t, way_off_nut(t, t.from.position));
    t.enter(Phase::change_tool, t.waypoints.empty() ? t.profile.reach_time : reach_duration(t));
}

// Returns true if the joint of the plan needs another tool than the one in use; then it is being changed.
bool change_tool(TraineeState& t) {
    const std::size_t needed = t.setup->nuts[t.plan.joint].tool;
    if (t.plan.fingers || needed == t.setup->tool) return false;
    if (t.obstacles() != nullptr && t.holds_wrench && t.from.position != t.rest.position) {
        go_to_rest(t);
        return true;
    }
    t.holds_wrench = false;  // the hand opens, and the other tool lies ready
    t.tool = static_cast<std::uint8_t>(needed);
    t.enter(Phase::pause, 0.2);
    return true;
}

}  // namespace

void begin_next_action(TraineeState& t) {
    const lesson::LessonStep* due = next_step(*t.lesson, t.plan);
    if (due == nullptr) {
        t.enter(Phase::done);
        return;
    }
    // After a stroke that only ran out of room the plan stays the same.
    if (t.step_is_past() || t.plan.wrong_joint || t.plan.finished) {
        if (t.step_is_past()) t.nut_follows_back = false;
        t.nut_angle_at_start = t.servo_state->joints[due->joint].nut.angle;
        t.free_turn = 0.0;
        t.plan =
            make_step_plan(t.profile, t.random, *t.setup, *t.lesson, {*due, t.nut_angle_at_start}, t.plan);
        t.last_common_turn = t.joint().common_turn;
        t.seen_common_turn = 0.0;
    }
    if (change_tool(t)) return;
    if (t.plan.fingers) {
        t.flipped = false;
        t.handle_angle = t.random.uniform(0.0, 2.0 * pi);
        t.hover_height = default_hover;
    } else {
        choose_handle_angle(t);
    }
    const double search_time = search_view(t);
    t.placement_error = random_placement_error(t);
    const bool tool_change = t.holds_wrench == t.plan.fingers;
    if (t.obstacles() != nullptr && tool_change && t.from.position != t.rest.position) {
        go_to_rest(t);
        return;
    }
    t.holds_wrench = !t.plan.fingers;
    // A hand that obstacles have caught again and again does not get out of there; from the rest pose it
    // does.
    const bool boxed_in = t.obstacles() != nullptr && t.consecutive_catches >= max_catches &&
                          glm::distance(t.hand.position, t.rest.position) > caught_distance;
    if (boxed_in) {
        go_to_rest(t);
        return;
    }
    const bool holds_other_part = t.lacks_second_wrench() && !t.plan.forgets_second_wrench;
    if (holds_other_part) t.second_wrench = static_cast<std::int16_t>(t.plan.joint);
    const double pause = std::max(search_time, holds_other_part ? second_wrench_time : 0.0);
    if (pause > 0.0) {
        t.enter(Phase::search_view, pause);
        return;
    }
    start_reach(t);
}

void start_reach(TraineeState& t) {
    t.visibility.eye = t.next_eye;
    // The reach starts at the hand's actual pose, which a force may have deflected from the intended one.
    if (t.obstacles() != nullptr) {
        t.from = t.hand;
        t.intended_pose_jumped = true;
    }
    t.to = t.tool_at_nut(t.hover_height);
    plan_path(t, t.nut().axis);
    t.enter(Phase::reach, reach_duration(t) * t.random.uniform(0.85, 1.2));
}

void choose_handle_angle(TraineeState& t) {
    const double sign = t.plan.loosening ? -1.0 : 1.0;
    // After repeated misses, catches or fruitless strokes the trainee tries from another side.
    const bool in_vain = t.consecutive_misses > max_misses || t.fruitless_strokes > max_fruitless ||
                         t.consecutive_catches > max_catches;
    const double other_side = in_vain ? t.random.uniform(-1.0, 1.0) * pi : 0.0;
    const motion::HandleAngle handle = motion::choose_handle_angle(
        *t.setup, t.obstacles(), t.plan.joint, t.joint(), t.nut().sense * 0.5 * pi - 0.5 * sign + other_side,
        sign, t.profile.stroke);
    t.handle_angle = handle.angle + t.profile.angle_noise * t.random.normal();
    t.flipped = handle.flipped;
    t.free_swing = handle.free_swing;
    t.hover_height = t.obstacles() == nullptr
                         ? default_hover
                         : motion::hover_height(*t.setup, *t.obstacles(), t.plan.joint, t.joint().nut.angle,
                                                handle, default_hover);
}

bool start_next_waypoint(TraineeState& t, Phase phase) {
    t.from = t.to;
    if (t.waypoints.empty()) return false;
    t.to = t.waypoints.back();
    t.waypoints.pop_back();
    t.enter(phase, reach_duration(t));
    return true;
}

void start_lift(TraineeState& t, const Pose& pose, double seconds) {
    t.from = pose;
    t.to = t.tool_at_nut(t.hover_height);
    t.enter(Phase::lift, seconds);
}

void adopt_wrench_pose(TraineeState& t) {
    const servo::NutGeometry& nut = t.nut();
    const Vec3 x = t.hand.orientation * Vec3(1, 0, 0);
    t.handle_angle += wrap(servo::angle_of(nut, x) - t.handle_angle, 2.0 * pi);
    // Along the bolt the intended pose stays: the jaw has only begun to slide onto the nut.
    const Vec3 offset = t.hand.position - servo::nut_centre(nut, t.joint().nut.angle);
    t.placement_error = offset + nut.axis * glm::dot(nut.axis, t.placement_error - offset);
}

Vec3 retreat_direction(int catches, const Vec3& up, Vec3 back, Vec3 aside) {
    // The rest pose may be behind the workpiece; a key never leaves its socket inwards.
    back -= up * std::min(0.0, glm::dot(up, back));
    aside -= up * glm::dot(up, aside);
    if (catches % 2 == 1) return up + 0.3 * static_cast<double>(std::min(catches, 5)) * unit(back);
    return 0.3 * up + unit(aside);
}

void retreat_if_caught(TraineeState& t, const Pose& intended, const Pose& wrench) {
    const bool in_transit = t.phase == Phase::reach || t.phase == Phase::lower ||
                            t.phase == Phase::change_tool || t.phase == Phase::lift ||
                            t.phase == Phase::pause;
    if (!in_transit || glm::distance(intended.position, wrench.position) < caught_distance) {
        t.caught_time = 0.0;
        if (t.phase == Phase::lower) t.consecutive_catches = 0;
        return;
    }
    t.caught_time += t.setup->dt;
    if (t.caught_time < caught_delay) return;
    t.caught_time = 0.0;
    ++t.consecutive_catches;
    t.from = wrench;
    const Vec3 direction =
        retreat_direction(t.consecutive_catches, way_off_nut(t, wrench.position),
                          t.rest.position - wrench.position, wrench.position - intended.position);
    t.to = {wrench.position + retreat * direction, wrench.orientation};
    t.intended_pose_jumped = true;
    t.enter(Phase::lift, 0.6);
}

namespace {

constexpr double seated_speed = 0.5;   // of the fingers' speed; a nut that turns more slowly is seated
constexpr double spin_stroke = 200.0;  // degrees of one finger twist
constexpr double free_stroke = 40.0;   // degrees at less than free_torque after which the nut is free
constexpr double free_torque = 1.0;    // N·m at the wrench
constexpr double visible_turn = to_radians(0.5);  // smallest rotation of the nut that is visible
constexpr double missing_click = 1.3;  // of the goal; if the wrench has not clicked by then, the pull stops
constexpr double min_turn = to_radians(1.0);  // rotation of the nut that makes a stroke worthwhile
constexpr double tight_share = 0.7;           // share of the goal that makes a stroke worthwhile

constexpr double unload_time = 0.18;  // s in which the wrench springs back before it is lifted

// rad to the angle at which the trainee means to stop; nothing is left if it is not positive.
double remaining_angle(const TraineeState& t) {
    const lesson::JointTrack& track = t.lesson->joints[t.plan.joint];
    const double angle = t.joint().nut.angle;
    if (t.plan.loosening) return t.plan.goal_angle - (track.begin_angle - angle);
    return t.plan.goal_angle - (track.mark ? angle - *track.mark : 0.0);
}

}  // namespace

// A hand on a wrench controls the torque: its rate decreases towards the goal, a torque or an angle, and the
// hand follows the nut when it turns. The handle's speed follows from dT/dt = K (hand speed − nut speed).
void pull(TraineeState& t, const Percept& felt) {
    const TraineeProfile& profile = t.profile;
    StepPlan& plan = t.plan;
    const double load = std::abs(felt.torque);
    const double nut_speed = std::abs(t.joint().nut.speed);
    const double stiffness = t.setup->wrench.stiffness, dt = t.setup->dt;
    const double scale = plan.loosening ? stiffness * to_radians(1.0) : plan.goal_torque;
    // The hand anticipates the growth of the torque during its reaction time, both for slowing down and for
    // stopping. With the delayed torque alone it would overshoot the goal.
    const double growth = profile.anticipation * profile.reaction * std::max(felt.torque_rate, 0.0);
    const bool by_angle = plan.goal_angle > 0.0;
    const double missing = plan.loosening ? 1.0
                           : by_angle     ? remaining_angle(t) / plan.goal_angle
                                          : 1.0 - (load + growth) / plan.goal_torque;
    const double rate = scale * std::max(profile.final_rate, profile.load_rate * missing);
    const double fastest = profile.pull_speed * (plan.only_checks ? 0.2 : 1.0);
    const double speed = std::min(fastest * std::min(1.0, t.elapsed() / 0.15), rate / stiffness + nut_speed);
    t.handle_angle += (plan.loosening ? -1.0 : 1.0) * speed * dt;

    if (plan.loosening) {
        t.free_turn = load < free_torque ? t.free_turn + nut_speed * dt : 0.0;
        plan.finished = t.free_turn > to_radians(free_stroke) || (by_angle && remaining_angle(t) <= 0.0);
    } else if (by_angle) {
        plan.finished = remaining_angle(t) - profile.anticipation * profile.reaction * nut_speed <= 0.0;
    } else {
        plan.finished = (plan.until_click && felt.clicked) ||
                        load + growth >= (plan.until_click ? missing_click : 1.0) * plan.goal_torque ||
                        (plan.until_yield && felt.yields && load >= plan.min_torque) ||
                        (plan.only_checks && t.joint().nut.angle - t.nut_angle_at_start > visible_turn);
    }
    const bool no_free_swing = std::abs(t.handle_angle - t.stroke_start) >= t.free_swing;
    if (!plan.finished && !no_free_swing) return;
    // A handle that runs against an obstacle feels like a tight nut, but the joint's torque stays low.
    t.stroke_turn = t.joint().nut.angle - t.nut_angle_at_stroke;
    const bool turned = std::abs(t.stroke_turn) > min_turn;
    const bool tight = std::abs(t.joint().torque) > tight_share * plan.goal_torque;
    t.fruitless_strokes = turned || tight ? 0 : t.fruitless_strokes + 1;

    t.enter(Phase::unload, unload_time);
}

void spin(TraineeState& t, const Percept& felt) {
    t.handle_angle += t.profile.spin_speed * t.setup->dt * motion::minimum_jerk(t.elapsed() / 0.1);
    // The device's scale makes the torque of fingertips too small to feel, so the trainee detects a seated
    // nut by sight.
    const bool started = t.elapsed() > 0.1 + t.profile.reaction + t.arm_lag;
    t.plan.finished = started && felt.nut_speed < seated_speed * t.profile.spin_speed;
    if (t.plan.finished || t.handle_angle - t.stroke_start > to_radians(spin_stroke))
        t.enter(Phase::spin_back, t.plan.finished ? 0.3 : 0.12);
}

void unload(TraineeState& t) {
    const double deflection = t.joint().torque / t.setup->wrench.stiffness + t.servo_state->engagement.swung;
    t.handle_angle -= deflection * std::min(1.0, t.setup->dt / 0.04) * std::min(1.0, t.elapsed() / 0.03);
}

bool pulls_again(const TraineeState& t) {
    return t.setup->wrench.ratchet.tooth_angle > 0.0 && !t.plan.finished && !t.step_is_past() &&
           !t.nut_follows_back && t.holds_intended_nut() && t.fruitless_strokes <= max_fruitless;
}

// A free nut has less friction than the pawl of a ratchet, so the handle takes it along when it swings back.
// The trainee sees that, and from then on takes the ratchet off after each pull, so that the nut stays free.
void notice_free_nut(TraineeState& t) {
    constexpr double taken_back = 0.5;  // share of the stroke
    if (!t.plan.loosening || std::abs(t.stroke_turn) < min_turn) return;
    const double net = t.joint().nut.angle - t.nut_angle_at_stroke;
    if (std::abs(net) >= (1.0 - taken_back) * std::abs(t.stroke_turn)) return;
    t.nut_follows_back = true;
    t.plan.finished = true;
}

void notice_common_turn(TraineeState& t) {
    if (!t.lacks_second_wrench()) return;
    t.seen_common_turn += std::abs(t.joint().common_turn - t.last_common_turn);
    t.last_common_turn = t.joint().common_turn;
    if (t.seen_common_turn < noticed_turn) return;
    t.plan.forgets_second_wrench = false;
    t.second_wrench = static_cast<std::int16_t>(t.plan.joint);
}

void swing_back(TraineeState& t) {
    t.handle_angle = t.stroke_end + (t.stroke_start - t.stroke_end) * motion::minimum_jerk(t.progress());
}

void spin_back(TraineeState& t) {
    if (!t.plan.finished) t.handle_angle -= to_radians(spin_stroke) / t.phase_duration * t.setup->dt;
}

}  // namespace bolt::trainees
