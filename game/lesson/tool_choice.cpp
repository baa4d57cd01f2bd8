#include "game/lesson/tool_choice.hpp"

#include <algorithm>

#include "game/tool_models/tool_model.hpp"

namespace bolt::lesson {

namespace {

// The faults if the trainee chooses the tool of this name; empty if a tool does not fit its joint.
std::vector<ToolFault> faults_with(const content::Assembly& assembly, std::string_view chosen, Task task) {
    std::vector<ToolFault> faults;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        faults.push_back(ToolFault::none);
        if (!joint.tool.empty()) continue;
        const std::size_t tool = content::tool_if_chosen(assembly, joint, chosen);
        const content::WrenchDesign& design =
            assembly.tools[tool].name == assembly.tool ? assembly.wrench : assembly.tools[tool].wrench;
        if (!content::suits(design, joint.design)) return {};
        faults.back() = fault_of(design, joint, task);
        const bool is_published = assembly.law == joint::Law::published;
        if (is_published && faults.back() == ToolFault::too_weak) faults.back() = ToolFault::none;
    }
    return faults;
}

bool has_fault(const std::vector<ToolFault>& faults) {
    return std::any_of(faults.begin(), faults.end(),
                       [](ToolFault fault) { return fault != ToolFault::none; });
}

}  // namespace

ToolFault fault_of(const content::WrenchDesign& tool, const content::AssemblyJoint& joint, Task task) {
    if (task == Task::loosen && content::is_torque_wrench(tool.kind)) return ToolFault::torque_wrench_loosens;
    const double bearable = tool_models::bearable_torque(tool);
    return bearable > 0.0 && joint.spec.torque.high > bearable ? ToolFault::too_weak : ToolFault::none;
}

std::vector<ToolFault> faults_of_choice(const content::Assembly& assembly, Task task) {
    const std::vector<ToolFault> none(assembly.joints.size(), ToolFault::none);
    if (assembly.tools.size() < 2) return none;
    std::vector<ToolFault> faults = faults_with(assembly, assembly.tool, task);
    if (!has_fault(faults)) return none;
    for (const content::Tool* other : content::choosable_tools(assembly)) {
        const std::vector<ToolFault> with_other = faults_with(assembly, other->name, task);
        if (!with_other.empty() && !has_fault(with_other)) return faults;
    }
    return none;
}

}  // namespace bolt::lesson
