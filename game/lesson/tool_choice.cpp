#include "game/lesson/tool_choice.hpp"

#include <algorithm>
#include <vector>

#include "game/tool_models/tool_model.hpp"

namespace bolt::lesson {

double bearable_torque(const content::WrenchDesign& tool) {
    const tool_models::TestTorque limit = tool_models::strength_of(tool).limit;
    return limit.source == tool_models::TorqueSource::none ? tool_models::yield_torque(tool) : limit.torque;
}

ToolFault fault_of(const content::WrenchDesign& tool, const content::AssemblyJoint& joint, Task task) {
    if (task == Task::loosen && content::is_torque_wrench(tool.kind)) return ToolFault::torque_wrench_loosens;
    const double bearable = bearable_torque(tool);
    return bearable > 0.0 && joint.spec.torque.high > bearable ? ToolFault::too_weak : ToolFault::none;
}

ToolFault fault_of_choice(const content::Assembly& assembly, std::size_t joint, Task task) {
    const content::AssemblyJoint& turned = assembly.joints[joint];
    const ToolFault fault = fault_of(content::tool_of(assembly, turned), turned, task);
    if (fault == ToolFault::none) return fault;
    const std::vector<std::size_t> tools = content::tools_of_joint(assembly, joint);
    const bool has_better = std::any_of(tools.begin(), tools.end(), [&](std::size_t tool) {
        const content::WrenchDesign& design = assembly.tools[tool].wrench;
        return content::suits(design, turned.design) && fault_of(design, turned, task) == ToolFault::none;
    });
    return has_better ? fault : ToolFault::none;
}

}  // namespace bolt::lesson
