#include <algorithm>
#include <utility>

#include "game/lesson/plan.hpp"

namespace bolt::lesson {

namespace {

constexpr double finger_drag = 0.4;  // share of the finger torque; a nut with more drag needs the wrench

StepKind kind_of(content::PassKind kind) {
    switch (kind) {
        case content::PassKind::run_down:
            return StepKind::run_down;
        case content::PassKind::turn:
            return StepKind::turn;
        case content::PassKind::recheck:
            return StepKind::recheck;
        case content::PassKind::loosen:
            return StepKind::loosen;
        case content::PassKind::tighten:
            break;
    }
    return StepKind::tighten;
}

double set_torque(const content::Assembly& assembly, const LessonStep& step) {
    if (step.kind != StepKind::tighten && step.kind != StepKind::recheck) return 0.0;
    const content::WrenchDesign& wrench = content::tool_of(assembly, assembly.joints[step.joint]);
    return wrench.click_swing > 0.0 ? step.torque / content::adaptor_ratio(wrench) : 0.0;
}

std::vector<LessonStep> plan_loosening(const content::Assembly& assembly) {
    std::vector<LessonStep> steps;
    int number = 0;
    for (const content::Pass& pass : loosening_passes(assembly)) {
        for (const std::size_t joint : pass.order)
            steps.push_back({StepKind::loosen, joint, 0.0, 0.0, number, pass.turn_back});
        ++number;
    }
    return steps;
}

}  // namespace

std::vector<content::Pass> loosening_passes(const content::Assembly& assembly) {
    if (!assembly.loosening.empty() || assembly.passes.empty()) return assembly.loosening;
    content::Pass pass;
    pass.kind = content::PassKind::loosen;
    const auto& order = assembly.passes.back().order;
    pass.order.assign(order.rbegin(), order.rend());
    return {pass};
}

std::vector<LessonStep> make_plan(const content::Assembly& assembly, Task task) {
    std::vector<LessonStep> steps;
    if (assembly.passes.empty()) return steps;
    if (task == Task::loosen) return plan_loosening(assembly);
    int number = 0;
    for (const content::Pass& pass : assembly.passes) {
        for (const std::size_t joint : pass.order) {
            const double fraction = pass.kind == content::PassKind::tighten ? pass.fraction : 1.0;
            const content::Specification& spec = assembly.joints[joint].spec;
            LessonStep step{kind_of(pass.kind), joint, spec.torque.target * fraction, fraction, number};
            if (step.kind == StepKind::turn) {
                step.fraction = pass.fraction;
                step.angle = spec.angle.target * pass.fraction;
            }
            step.set_torque = set_torque(assembly, step);
            steps.push_back(step);
        }
        ++number;
    }
    return steps;
}

bool turns_by_angle(const content::Assembly& assembly) {
    return std::any_of(assembly.passes.begin(), assembly.passes.end(),
                       [](const content::Pass& pass) { return pass.kind == content::PassKind::turn; });
}

bool uses_fingers(const content::Assembly& assembly, const servo::Setup& setup, const LessonStep& step,
                  double nut_angle) {
    if (step.kind != StepKind::run_down) return false;
    const double drag = setup.group.law == joint::Law::mechanistic
                            ? joint::prevailing_torque(setup.group.joints[step.joint], nut_angle)
                            : assembly.joints[step.joint].design.prevailing_torque;
    return drag < finger_drag * setup.finger_torque(setup.nuts[step.joint]);
}

content::ToleranceWindow angle_window(const content::Assembly& assembly, const LessonStep& step) {
    const content::ToleranceWindow& whole = assembly.joints[step.joint].spec.angle;
    return {whole.target * step.fraction, whole.low * step.fraction, whole.high * step.fraction};
}

}  // namespace bolt::lesson
