// Reads and checks the joint types of an assembly file: thread sizes, materials, designs and specifications.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

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
    bool materials_are_valid = true;  // false: the file's own materials could not be read
};

YoungsModuli read_youngs_moduli(JsonReader& reader);

struct JointType {
    joint::JointDesign design;
    Specification spec;
    PublishedJoint published;
    std::string tool;  // AssemblyJoint::tool
};

// Reads a joint type with its patches applied, and reports its errors, including inconsistent values. After
// an error the result serves only for further checks. `smallest_pass_fraction`: smallest fraction of the
// target torque that a pass tightens to.
JointType read_joint_type(const LayeredObject& layers, const YoungsModuli& moduli,
                          double smallest_pass_fraction);

// Reads the form of the joint, the part that is turned, the direction of the thread, and the tapped hole.
void read_form(const LayeredObject& layers, joint::JointDesign& design);

// The prevailing torque, N·m, of a locking nut whose file gives none: half of the largest that ISO 2320
// allows; 0 for other nuts.
double usual_prevailing_torque(const joint::JointDesign& design);

// The torques and angles in `spec`: a joint's specification, or the targets of the published law.
Specification read_spec(const LayeredObject& spec);

// Reads a joint under the published law and reports its errors. `layers`: the objects "published" of the
// patches, of the joint type and of the file, in this order. Each value is read from the first object that
// has it; if none has it, it is that of Table 1 of the 2018 paper.
PublishedJoint read_published(const LayeredObject& layers);

// Checks the consistency of a joint type: lengths, torques, windows. Checks that need an invalid or missing
// value are skipped.
void check_joint_type(const LayeredObject& layers, const JointType& type, double smallest_pass_fraction);

// Checks that ids and nodes are unique and that the turned parts of two joints do not overlap. `nodes`: the
// values in "joints" that the joints were read from.
void check_joints(JsonReader& reader, const std::vector<JsonNode>& nodes,
                  const std::vector<AssemblyJoint>& joints);

// Checks that limits come in pairs and are not combined with a tolerance.
void check_limits(const LayeredObject& spec);
// Checks snug torque < lowest torque ≤ target ≤ highest torque.
void check_torques(const LayeredObject& spec, const ToleranceWindow& torque, double snug_torque);
// Checks that the target angle is within its window, and that the strategy has the angles it needs.
void check_angles(const LayeredObject& spec, const Specification& s);

}  // namespace bolt::content
