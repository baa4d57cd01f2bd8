#include "game/lesson/plan.hpp"

#include <algorithm>

namespace bolt::lesson {

namespace {

constexpr double finger_drag = 0.4;  // of what fingers can give: a nut that drags more is run down by wrench

StepKind kind_of(content::StepKind kind) {
    switch (kind) {
        case content::StepKind::run_down:
            return StepKind::run_down;
        case content::StepKind::recheck:
            return StepKind::recheck;
        case content::StepKind::tighten:
            break;
    }
    return StepKind::tighten;
}

}  // namespace

content::Assembly under_law(content::Assembly assembly, joint::Law law) {
    assembly.law = law;
    if (law == joint::Law::mechanistic) return assembly;
    const double most = 0.98 * assembly.published.T_max_Nm;
    for (content::AssemblyJoint& joint : assembly.joints) {
        joint.spec.strategy = content::Strategy::torque;
        joint.spec.has_angle = false;
        joint.spec.target_clamp = 0.0;
        if (assembly.published_targets) {
            joint.spec.torque = assembly.published_targets->torque;
            joint.spec.snug_torque = assembly.published_targets->snug_torque;
            continue;
        }
        joint.spec.torque.target = std::min(joint.spec.torque.target, most);
        joint.spec.torque.low = std::min(joint.spec.torque.low, 0.95 * joint.spec.torque.target);
    }
    return assembly;
}

std::vector<Step> make_plan(const content::Assembly& assembly, Task task) {
    std::vector<Step> steps;
    if (assembly.passes.empty()) return steps;
    if (task == Task::loosen) {
        const auto& order = assembly.passes.back().order;
        for (auto joint = order.rbegin(); joint != order.rend(); ++joint)
            steps.push_back({StepKind::loosen, *joint, 0.0, 0.0, 0});
        return steps;
    }
    int number = 0;
    for (const content::Pass& pass : assembly.passes) {
        for (const std::size_t joint : pass.order) {
            const double fraction = pass.kind == content::StepKind::tighten ? pass.fraction : 1.0;
            const double torque = assembly.joints[joint].spec.torque.target * fraction;
            steps.push_back({kind_of(pass.kind), joint, torque, fraction, number});
        }
        ++number;
    }
    return steps;
}

bool by_fingers(const content::Assembly& assembly, const Step& step, double finger_torque) {
    return step.kind == StepKind::run_down &&
           assembly.joints[step.joint].design.prevailing_torque < finger_drag * finger_torque;
}

}  // namespace bolt::lesson
