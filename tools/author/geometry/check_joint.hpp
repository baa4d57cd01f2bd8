// Checks of one joint against its model: sizes, contact and overlap of the fasteners and members, and room
// for the wrench.
#pragma once

#include "content/format/assembly.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"
#include "tools/author/geometry/wrench.hpp"

namespace bolt::geometry {

// Returns false if the joint has no nut that a wrench can grip. `index`: of the joint in the file.
// `everything`: all parts, in the assembly's frame. `jaw`: opening of the wrench, m.
bool check_stack(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                 const FlattenedModel& scene, const Bvh& everything, double jaw, const Messages& messages);

// Checks that the wrench can be brought onto the nut and swings far enough on it.
void check_wrench(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                  const FlattenedModel& scene, const WrenchShape& wrench, const Messages& messages);

}  // namespace bolt::geometry
