// Bolt, washers, nut and members of a joint: sizes as the file says, each on the next, none inside another.
#pragma once

#include "content/format/assembly.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/joint_parts.hpp"
#include "tools/author/geometry/messages.hpp"

namespace bolt::geometry {

// False if the joint has no nut that a wrench could grip. `everything`: all parts, in the assembly's frame.
bool check_stack(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                 const Scene& scene, const Bvh& everything, double jaw, const Messages& messages);

}  // namespace bolt::geometry
