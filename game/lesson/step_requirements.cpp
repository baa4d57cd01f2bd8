#include "game/lesson/step_requirements.hpp"

#include <algorithm>

namespace bolt::lesson {

content::ToleranceWindow torque_window(const Lesson& lesson, const LessonStep& step) {
    const content::ToleranceWindow& whole = lesson.assembly->joints[step.joint].spec.torque;
    if (whole.target <= 0.0) return {step.torque, step.torque, step.torque};
    const double share = step.torque / whole.target;
    return {step.torque, share * whole.low, share * whole.high};
}

double angle_from_mark(const Lesson& lesson, const world::ReadJoints& world, std::size_t joint) {
    const JointTrack& track = lesson.joints[joint];
    return track.mark ? world::joint_at(world, joint).angle - *track.mark : 0.0;
}

bool requires_yield(const Lesson& lesson, const LessonStep& step) {
    return step.kind == StepKind::tighten && step.fraction > 0.999 &&
           lesson.assembly->joints[step.joint].spec.strategy == content::Strategy::yield;
}

bool needs_second_wrench(const content::Assembly& assembly, std::size_t joint) {
    return assembly.law == joint::Law::mechanistic &&
           assembly.joints[joint].design.counter_hold == joint::CounterHold::second_wrench;
}

bool needs_second_wrench(const content::Assembly& assembly) {
    for (std::size_t i = 0; i < assembly.joints.size(); ++i)
        if (needs_second_wrench(assembly, i)) return true;
    return false;
}

bool requires_click(const Lesson& lesson, const LessonStep& step) {
    const content::Assembly& assembly = *lesson.assembly;
    const content::WrenchDesign& wrench = *lesson.tools[step.joint];
    if (assembly.law != joint::Law::published || wrench.click_swing <= 0.0) return false;
    const double greatest_click = step.torque * (1.0 + wrench.click_accuracy);
    return step.kind == StepKind::tighten &&
           greatest_click < assembly.joints[step.joint].published.law.T_max_Nm;
}

}  // namespace bolt::lesson
