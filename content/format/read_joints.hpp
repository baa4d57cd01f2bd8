// The thread size that an author wrote.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "content/format/assembly.hpp"
#include "content/format/reader.hpp"
#include "engine/base/result.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::content {

// Only the exact name is taken ("M12", "M12x1.75"), but the error knows other ways of writing it ("M12 ×
// 1,75"). It never proposes another diameter than the one that was written: that would be another bolt.
Result<joint::ThreadSize> read_thread(std::string_view text);

// A joint type of the file, under its patches, as design and specification.

// Young's moduli by name, Pa: the built-in materials and the file's own.
struct Materials {
    std::map<std::string, double> E;
    bool complete = true;  // false: the file's own could not be read
};

Materials read_materials(Reader& reader);

struct JointType {
    joint::JointDesign design;
    Specification spec;
};

// Reports what is wrong with it, also how its values fit together. Where something is, the result is only
// good for looking further. `least_share`: of the target torque, the least that a pass tightens to.
JointType read_joint_type(const Layers& layers, const Materials& materials, double least_share);

// How the values of a joint type fit together: lengths, torques, windows. What was refused, or is not there,
// keeps only those checks from being made that need it.
void check_joint_type(const Layers& layers, const JointType& type, double least_share);

// The torques that `spec` asks for: a joint's specification, or the targets of the published law.
Window read_torque(const Layers& spec);
double read_snug_torque(const Layers& spec, const Window& torque);

// Limits come in pairs, and a tolerance stands instead of them.
void check_limits(const Layers& spec);
// Snug torque < lowest torque ≤ target ≤ highest torque.
void check_torques(const Layers& spec, const Window& torque, double snug_torque);

}  // namespace bolt::content
