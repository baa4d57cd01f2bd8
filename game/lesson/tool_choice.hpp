// The judgement of the tool that a trainee chose. A lesson leaves the choice open if its assembly has several
// tools for a joint (content::tools_of_joint); a tool that the author assigned to a joint is not judged.
#pragma once

#include <cstddef>
#include <cstdint>

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"

namespace bolt::lesson {

enum class ToolFault : std::uint8_t {
    none,
    too_weak,              // the joint's highest permitted torque exceeds what the tool is tested with
    torque_wrench_loosens  // torque wrenches are for tightening only (ISO 6789)
};

// N·m that a tool bears by its test torque, or that of its square drive. No test torque of keys is known: a
// key bears the torque at which it begins to bend.
double bearable_torque(const content::WrenchDesign& tool);

// The fault of a tool on a joint, whoever chose it.
ToolFault fault_of(const content::WrenchDesign& tool, const content::AssemblyJoint& joint, Task task);

// The fault of the tool that turns a joint, for which the trainee is responsible: `none` if no other tool
// that can be chosen fits the joint without a fault.
ToolFault fault_of_choice(const content::Assembly& assembly, std::size_t joint, Task task);

}  // namespace bolt::lesson
