#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/lesson/fastener_names.hpp"
#include "game/lesson/judge.hpp"
#include "game/lesson/step_requirements.hpp"

namespace bolt::lesson {

namespace {

Verdict within(double value, const content::ToleranceWindow& window) {
    return value < window.low ? Verdict::low : value > window.high ? Verdict::high : Verdict::ok;
}

Verdict worst(Verdict a, Verdict b) {
    if (a == Verdict::none) return b;
    if (b == Verdict::none || b == Verdict::ok) return a;
    return b;
}

std::string times(int n) { return n == 1 ? "once" : fmt::format("{} times", n); }

void take_points(LessonResult& result, Deduction reason) {
    reason.points = -reason.points;
    result.score += reason.points;
    result.reasons.push_back(std::move(reason));
}

}  // namespace

ToolReading tool_reading(const Lesson& lesson, const world::ReadHaptics& world) {
    if (lesson.held_joint < 0 || lesson.grip != servo::Grip::wrench) return {};
    const auto held = static_cast<std::size_t>(lesson.held_joint);
    const double ratio = content::adaptor_ratio(*lesson.tools[held]);
    ToolReading reading{std::abs(world::joint_at(world, held).torque) / ratio};
    const LessonStep* due = lesson.due();
    if (due == nullptr || due->joint != held || due->kind == StepKind::loosen ||
        due->kind == StepKind::run_down)
        return reading;
    const bool by_angle = due->kind == StepKind::turn;
    const content::ToleranceWindow window =
        by_angle ? angle_window(*lesson.assembly, *due) : torque_window(lesson, *due);
    const double measured = by_angle ? angle_from_mark(lesson, world, held) : ratio * reading.value;
    if (by_angle) reading.value = to_degrees(measured);
    if (window.high > 0.0 && measured >= window.low)
        reading.target = measured > window.high ? world::TargetState::exceeded : world::TargetState::reached;
    return reading;
}

JointResult judge_joint(const Lesson& lesson, std::size_t index, const world::ReadJoints& world) {
    const JointTrack& track = lesson.joints[index];
    const content::Specification& spec = lesson.assembly->joints[index].spec;
    const world::Joint& joint = world::joint_at(world, index);
    JointResult result = track.result;
    result.clamp = joint.clamp;
    result.condition = joint.condition;
    if (lesson.task == Task::loosen) {
        result.torque_verdict = result.torque > 0.0 ? Verdict::ok : Verdict::none;
        result.overall = result.torque_verdict;
    } else {
        // The highest torque at which the nut turned counts even outside the joint's own step. A joint
        // without a full tightening step is judged by its peak torque.
        result.torque = std::max(result.torque, track.turned_torque);
        if (result.torque == 0.0) result.torque = track.peak_torque;
        result.torque_verdict = within(result.torque, spec.torque);
        if (spec.has_angle) result.angle_verdict = within(result.angle, spec.angle);
        result.overall = worst(result.torque_verdict, result.angle_verdict);
        // A nut off its seat has no clamp force, whatever its torque was.
        if (joint.stage == joint::Stage::navigation) result.overall = Verdict::low;
    }
    if (result.condition != joint::JointCondition::intact) result.overall = Verdict::high;
    return result;
}

LessonResult judge(const Lesson& lesson, const world::ReadHaptics& world, double dt) {
    LessonResult result;
    result.duration = static_cast<double>(world.only<world::ServoClock>().tick) * dt;
    result.finished = lesson.due() == nullptr;
    result.score = 100.0;
    const double share = 100.0 / static_cast<double>(std::max<std::size_t>(1, lesson.joints.size()));
    int done_already = 0, out_of_turn = 0, wrong_ways = 0, overdone = 0, overturned = 0, slips = 0,
        common_turns = 0, bent = 0;
    for (std::size_t i = 0; i < lesson.joints.size(); ++i) {
        JointResult joint = judge_joint(lesson, i, world);
        if (joint.condition != joint::JointCondition::intact)
            take_points(result, {1.5 * share, fmt::format("{} is {}", joint.id, joint::name(joint.condition)),
                                 DeductionKind::damaged, static_cast<int>(i), 1});
        else if (joint.overall != Verdict::ok)
            take_points(result,
                        {share,
                         fmt::format("{}: torque {} ({:.1f} N·m), angle {}", joint.id,
                                     name(joint.torque_verdict), joint.torque, name(joint.angle_verdict)),
                         DeductionKind::not_ok, static_cast<int>(i), 1});
        done_already += joint.done_already;
        out_of_turn += joint.out_of_turn;
        wrong_ways += lesson.joints[i].wrong_way_count;
        slips += lesson.joints[i].slip_count;
        common_turns += lesson.joints[i].common_turn_count;
        bent += lesson.joints[i].bent_count;
        const bool still_too_high =
            joint.torque_verdict == Verdict::high || joint.condition != joint::JointCondition::intact;
        overdone += std::max(0, lesson.joints[i].over_torque_count - (still_too_high ? 1 : 0));
        const bool still_too_far = joint.angle_verdict == Verdict::high;
        overturned += std::max(0, lesson.joints[i].over_turn_count - (still_too_far ? 1 : 0));
        result.joints.push_back(std::move(joint));
    }
    if (out_of_turn > 0)
        take_points(result, {2.0 * out_of_turn, times(out_of_turn) + " a joint out of turn",
                             DeductionKind::out_of_turn, -1, out_of_turn});
    if (done_already > 0)
        take_points(result, {1.0 * done_already, times(done_already) + " a joint that was done already",
                             DeductionKind::done_already, -1, done_already});
    if (wrong_ways > 0)
        take_points(result, {1.0 * wrong_ways,
                             fmt::format("{} a {} was turned the wrong way", times(wrong_ways),
                                         fastener_name(*lesson.assembly)),
                             DeductionKind::wrong_way, -1, wrong_ways});
    if (overdone > 0)
        take_points(result, {2.0 * overdone, times(overdone) + " too much torque, corrected later",
                             DeductionKind::over_torque, -1, overdone});
    if (overturned > 0)
        take_points(result, {2.0 * overturned, times(overturned) + " turned too far, corrected later",
                             DeductionKind::over_turned, -1, overturned});
    if (slips > 0)
        take_points(result,
                    {2.0 * slips, times(slips) + " the wrench slipped", DeductionKind::slipped, -1, slips});
    if (common_turns > 0)
        take_points(result, {1.0 * common_turns, times(common_turns) + " nut and bolt turned together",
                             DeductionKind::turned_together, -1, common_turns});
    if (lesson.reported_tool_fault == ToolFault::too_weak)
        take_points(result, {5.0, "the chosen tool is too weak", DeductionKind::weak_tool, -1, 1});
    if (lesson.reported_tool_fault == ToolFault::torque_wrench_loosens)
        take_points(result, {5.0, "a torque wrench was used for loosening",
                             DeductionKind::torque_wrench_loosens, -1, 1});
    if (bent > 0)
        take_points(result,
                    {5.0 * bent, times(bent) + " the tool was bent", DeductionKind::tool_bent, -1, bent});
    if (!result.finished)
        take_points(result, {0.0,
                             fmt::format("the lesson was left at step {} of {}", lesson.current + 1,
                                         lesson.steps.size()),
                             DeductionKind::unfinished, -1, static_cast<int>(lesson.current) + 1,
                             static_cast<int>(lesson.steps.size())});
    result.score = std::clamp(result.score, 0.0, 100.0);
    return result;
}

}  // namespace bolt::lesson
