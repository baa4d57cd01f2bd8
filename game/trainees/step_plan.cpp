#include "game/trainees/step_plan.hpp"

#include <algorithm>

#include "game/lesson/step_requirements.hpp"

namespace bolt::trainees {

using lesson::StepKind;

const lesson::LessonStep* next_step(const lesson::Lesson& lesson, const StepPlan& plan) {
    const lesson::LessonStep* due = lesson.due();
    const bool believes_done = plan.finished && !plan.wrong_joint && plan.step == lesson.current;
    const bool moves_on = lesson.mode == lesson::Mode::assessment && believes_done;
    if (!moves_on) return due;
    return lesson.current + 1 < lesson.steps.size() ? due + 1 : nullptr;
}

StepPlan make_step_plan(const TraineeProfile& profile, Random& random, const servo::Setup& setup,
                        const lesson::Lesson& lesson, const NextStep& next, const StepPlan& before) {
    const lesson::LessonStep& due = next.step;
    const bool retry = &due == lesson.due() && before.step == lesson.current;
    const std::size_t joints = setup.nuts.size();
    StepPlan plan;
    plan.step = static_cast<std::size_t>(&due - lesson.steps.data());
    plan.attempt = retry ? before.attempt + 1 : 0;
    plan.joint = due.joint;
    const double drag = lesson.assembly->joints[due.joint].design.prevailing_torque;
    plan.until_seated = due.kind == StepKind::run_down;
    plan.fingers = lesson::uses_fingers(*lesson.assembly, setup, due, next.nut_angle);
    plan.loosening = due.kind == StepKind::loosen;
    plan.only_checks = due.kind == StepKind::recheck;
    if (!retry && !plan.fingers && joints > 1 && random.chance(profile.wrong_joint)) {
        // A nut of another size is not mistaken for the due one.
        const std::size_t other = (due.joint + 1 + random.bits() % (joints - 1)) % joints;
        plan.wrong_joint = setup.nuts[other].tool == setup.nuts[due.joint].tool;
        if (plan.wrong_joint) plan.joint = other;
    }
    plan.forgets_second_wrench = !plan.fingers && lesson::needs_second_wrench(*lesson.assembly, plan.joint) &&
                                 random.chance(profile.forgets_second_wrench);
    // With a torque wrench a trainee that means to stop at the target waits for the click.
    plan.until_click = !plan.wrong_joint && lesson::wrench_set_torque(lesson) > 0.0;
    double stop = 1.0 + profile.torque_bias + profile.torque_noise * random.normal();
    if (!retry && random.chance(profile.stops_early)) {
        stop *= 0.75;
        plan.until_click = false;
    }
    if (random.chance(profile.overtightens)) {
        stop *= 1.25;
        plan.until_click = false;
    }
    stop += 0.04 * plan.attempt;  // a retry means that the last torque was too low
    plan.goal_torque = (plan.wrong_joint ? 0.3 : 1.0) * due.torque * stop;
    // At rest the nut may resist more than its drag; after a pull in vain the trainee pulls harder.
    if (plan.until_seated) plan.goal_torque = (1.3 * drag + 2.0) * (1.0 + 0.1 * plan.attempt);
    // When tightening into yield, a trainee that feels yielding pulls until it occurs. It knows the lower and
    // upper torque limits.
    const content::Specification& spec = lesson.assembly->joints[plan.joint].spec;
    const bool full_target = due.kind == StepKind::tighten && due.fraction > 0.999;
    plan.until_yield = !plan.wrong_joint && full_target && spec.strategy == content::Strategy::yield &&
                       random.chance(profile.feels_yield);
    // A misjudged angle is off by the same share as a misjudged torque. On the wrong joint there is no mark.
    if (!plan.wrong_joint && due.angle > 0.0) plan.goal_angle = due.angle * std::max(stop, 0.2);
    plan.min_torque = spec.torque.low;
    if (plan.until_yield)
        plan.goal_torque =
            spec.torque.high * (std::min(0.98, stop - 0.04 * plan.attempt) + 0.04 * plan.attempt);
    return plan;
}

}  // namespace bolt::trainees
