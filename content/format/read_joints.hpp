// Reads and checks the joint types of an assembly file: thread sizes, materials, designs and specifications.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "content/format/assembly.hpp"
#include "content/format/reader.hpp"
#include "engine/base/result.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::content {

// Parses a thread size as an author writes it. Only the exact name is accepted ("M12", "M12x1.75"); the error
// recognises other spellings ("M12 × 1,75") and suggests the exact name. It never suggests another diameter,
// which would be another bolt.
Result<joint::ThreadSize> read_thread(std::string_view text);

// Young's moduli by material name, Pa: the built-in materials and the file's own.
struct YoungsModuli {
    std::map<std::string, double> E;
    bool complete = true;  // false: the file's own materials could not be read
};

YoungsModuli read_youngs_moduli(JsonReader& reader);

struct JointType {
    joint::JointDesign design;
    Specification spec;
};

// Reads a joint type with its patches applied, and reports its errors, including inconsistent values. After
// an error the result serves only for further checks. `smallest_pass_fraction`: smallest fraction of the
// target torque that a pass tightens to.
JointType read_joint_type(const LayeredObject& layers, const YoungsModuli& moduli,
                          double smallest_pass_fraction);

// Checks the consistency of a joint type: lengths, torques, windows. Checks that need an invalid or missing
// value are skipped.
void check_joint_type(const LayeredObject& layers, const JointType& type, double smallest_pass_fraction);

// The torques in `spec`: a joint's specification, or the targets of the published law.
ToleranceWindow read_torque(const LayeredObject& spec);
double read_snug_torque(const LayeredObject& spec, const ToleranceWindow& torque);

// Checks that limits come in pairs and are not combined with a tolerance.
void check_limits(const LayeredObject& spec);
// Checks snug torque < lowest torque ≤ target ≤ highest torque.
void check_torques(const LayeredObject& spec, const ToleranceWindow& torque, double snug_torque);

}  // namespace bolt::content
