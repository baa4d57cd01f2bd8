#include "game/lesson/plan.hpp"

namespace bolt::lesson {

namespace {

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

}  // namespace bolt::lesson
