#include "game/lesson/situation.hpp"

#include <cmath>

#include "game/lesson/step_requirements.hpp"

namespace bolt::lesson {

namespace {

constexpr double near = 0.06;                      // m from the nut within which the trainee has found it
constexpr double worn = 0.2e-3;                    // m of wear at each corner
constexpr double no_free_swing = to_radians(3.0);  // remaining swing of the handle
constexpr double last_part =
    0.8;  // share of the lowest valid torque or angle from which the trainee should pull slowly
constexpr double let_go_share = 0.5;     // share of the peak torque below which the pull has ended
constexpr double let_go_clicked = 0.15;  // the same after a click, which drops the torque by itself
constexpr double broken_loose = to_radians(2.0);
constexpr double backward_speed = 0.02;  // rad/s
constexpr double fingers_turning = 0.3;  // rad/s
constexpr double wrong_torque = 1.0;     // N·m; more than the wrench's elasticity returns
constexpr double wrong_share = 0.2;      // share of the step's torque
constexpr double worked_torque = 0.5;    // N·m

bool no_swing_left(const ObservedLesson& s) {
    const world::WorkingHand& hand = s.world.only<world::WorkingHand>();
    return hand.action == world::HandAction::holding && hand.free_swing < no_free_swing;
}

// True if the due joint needs the second wrench, and it is not there.
bool held_part_is_free(const ObservedLesson& s, const LessonStep& due) {
    return needs_second_wrench(*s.lesson.assembly, due.joint) &&
           s.world.only<world::ToolState>().second_wrench != static_cast<int>(due.joint);
}

Situation without_nut(const ObservedLesson& s, const LessonStep& due, bool fingers) {
    const bool wrench = wrench_in_hand(s);
    const bool other_tool = s.setup.tool != s.setup.nuts[due.joint].tool;
    if (wrench && (fingers || other_tool)) return Situation::put_wrench_away;
    if (!fingers && !wrench) return Situation::take_wrench;
    if (distance_to_due(s) > near) return fingers ? Situation::find_by_fingers : Situation::find_by_wrench;
    if (fingers) return Situation::grip_nut;
    if (held_part_is_free(s, due)) return Situation::counter_hold;
    if (world::joint_at(s.world, due.joint).rounded > worn) return Situation::set_on_rounded;
    const bool again = s.lesson.joints[due.joint].peak_torque > worked_torque;
    return again ? Situation::set_on_again : Situation::set_on;
}

Situation running_down(const ObservedLesson& s, const world::Joint& joint, bool fingers) {
    if (step_fulfilled(s.lesson, s.world)) return Situation::seated;
    const bool by_wrench = held_item(s) == HeldItem::nut_by_wrench;
    if (by_wrench && fingers) return Situation::put_wrench_away;
    if (!by_wrench && !fingers) return Situation::wrench_needed;
    if (joint.speed < -fingers_turning) return Situation::other_way_on;
    if (no_swing_left(s)) return fingers ? Situation::twist_back : Situation::set_back;
    return fingers ? Situation::run_down : Situation::run_down_by_wrench;
}

// True if the wrench loosens the nut in a step that tightens it.
bool turns_off(const LessonStep& due, const world::Joint& joint) {
    return (joint.torque < -wrong_torque && joint.speed < -backward_speed) ||
           joint.torque < -wrong_torque - wrong_share * due.torque;
}

Situation tightening(const ObservedLesson& s, const LessonStep& due, const world::Joint& joint) {
    if (held_item(s) == HeldItem::nut_by_fingers) return Situation::wrench_needed;
    const JointTrack& track = s.lesson.joints[due.joint];
    const content::ToleranceWindow window = torque_window(s.lesson, due);
    const bool checks = due.kind == StepKind::recheck;
    const bool to_yield = requires_yield(s.lesson, due);
    if (step_fulfilled(s.lesson, s.world)) {
        if (checks) return Situation::checked;
        const double share = track.clicked ? let_go_clicked : let_go_share;
        if (joint.torque < share * track.peak_torque) return Situation::take_off;
        if (track.peak_torque > window.high && track.turned_torque > window.high)
            return Situation::stop_too_much;
        if (track.clicked) return Situation::stop_at_click;
        return to_yield && track.yielded ? Situation::stop_at_yield : Situation::stop;
    }
    if (turns_off(due, joint)) return Situation::other_way_on;
    if (no_swing_left(s)) return Situation::set_back;
    if (checks) return Situation::check;
    if (const double set = wrench_set_torque(s.lesson); set > 0.0)
        return set < due.torque ? Situation::pull_to_click_by_adaptor : Situation::pull_to_click;
    const bool eases = joint.torque > last_part * window.low;
    if (to_yield) return eases ? Situation::ease_to_yield : Situation::pull_to_yield;
    return eases ? Situation::ease : Situation::pull;
}

Situation turning(const ObservedLesson& s, const LessonStep& due, const world::Joint& joint) {
    if (held_item(s) == HeldItem::nut_by_fingers) return Situation::wrench_needed;
    const content::ToleranceWindow window = angle_window(*s.lesson.assembly, due);
    const double turned = angle_from_mark(s.lesson, s.world, due.joint);
    if (step_fulfilled(s.lesson, s.world)) {
        if (joint.torque < let_go_share * s.lesson.joints[due.joint].peak_torque) return Situation::take_off;
        return turned > window.high ? Situation::stop_too_far : Situation::stop_at_angle;
    }
    if (turns_off(due, joint)) return Situation::other_way_on;
    if (no_swing_left(s)) return Situation::set_back;
    return turned > last_part * window.low ? Situation::ease_to_angle : Situation::turn_on;
}

Situation loosening(const ObservedLesson& s, const LessonStep& due, const world::Joint& joint) {
    if (step_fulfilled(s.lesson, s.world))
        return joint.stage == joint::Stage::navigation ? Situation::free : Situation::turned_back;
    if (held_item(s) == HeldItem::nut_by_fingers) return Situation::wrench_needed;
    const double turned = s.lesson.joints[due.joint].begin_angle - joint.angle;
    if (joint.torque > wrong_torque && joint.speed > backward_speed) return Situation::other_way_off;
    if (joint.torque > wrong_torque + wrong_share * s.lesson.assembly->joints[due.joint].spec.torque.target)
        return Situation::other_way_off;
    if (no_swing_left(s)) return Situation::set_back;
    if (turned <= broken_loose) return Situation::break_loose;
    return due.angle > 0.0 ? Situation::turn_back : Situation::unscrew;
}

}  // namespace

bool wrench_in_hand(const ObservedLesson& work) { return work.world.only<world::WorkingHand>().wrench; }

HeldItem held_item(const ObservedLesson& work) {
    if (work.lesson.held_joint >= 0)
        return work.lesson.grip == servo::Grip::fingers ? HeldItem::nut_by_fingers : HeldItem::nut_by_wrench;
    return wrench_in_hand(work) ? HeldItem::wrench : HeldItem::nothing;
}

double distance_to_due(const ObservedLesson& work) {
    const LessonStep* due = work.lesson.due();
    if (due == nullptr) return std::numeric_limits<double>::infinity();
    const Vec3 nut = world::nut_centre(work.world, work.setup, due->joint);
    return glm::distance(work.world.only<world::ConstrainedTool>().pose.position, nut);
}

Situation situation(const ObservedLesson& work) {
    const LessonStep* due = work.lesson.due();
    if (due == nullptr) return Situation::all_done;
    const world::Joint& joint = world::joint_at(work.world, due->joint);
    const bool fingers = uses_fingers(*work.lesson.assembly, work.setup, *due, joint.angle);
    if (work.lesson.held_joint < 0) return without_nut(work, *due, fingers);
    if (work.lesson.held_joint != static_cast<int>(due->joint)) return Situation::wrong_joint;
    if (joint.condition == joint::JointCondition::broken) return Situation::leave_broken;
    if (joint.condition == joint::JointCondition::stripped) return Situation::leave_stripped;
    if (held_item(work) == HeldItem::nut_by_wrench && held_part_is_free(work, *due) &&
        !step_fulfilled(work.lesson, work.world))
        return Situation::counter_hold;
    switch (due->kind) {
        case StepKind::run_down:
            return running_down(work, joint, fingers);
        case StepKind::tighten:
        case StepKind::recheck:
            return tightening(work, *due, joint);
        case StepKind::turn:
            return turning(work, *due, joint);
        case StepKind::loosen:
            return loosening(work, *due, joint);
    }
    return Situation::all_done;
}

}  // namespace bolt::lesson
