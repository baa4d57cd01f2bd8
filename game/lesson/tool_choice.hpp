// The judgement of the tool that a trainee chose. A lesson leaves the choice open if its assembly has several
// tools for a joint (content::tools_of_joint); a tool that the author assigned to a joint is not judged.
#pragma once

#include <cstdint>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"

namespace bolt::lesson {

enum class ToolFault : std::uint8_t {
    none,
    too_weak,              // the joint's highest permitted torque exceeds what the tool bears
    torque_wrench_loosens  // torque wrenches are for tightening only (ISO 6789)
};

// The fault of a tool on a joint, whoever chose it. A tool bears tool_models::bearable_torque().
ToolFault fault_of(const content::WrenchDesign& tool, const content::AssemblyJoint& joint, Task task);

// By joint, the faults for which the trainee is responsible: those of the chosen tool, Assembly::tool, on the
// joints whose type names no tool. All are `none` if each choice has a fault or does not fit. Under the
// published law no tool is too weak, because its torques are the same for all sizes.
std::vector<ToolFault> faults_of_choice(const content::Assembly& assembly, Task task);

}  // namespace bolt::lesson
