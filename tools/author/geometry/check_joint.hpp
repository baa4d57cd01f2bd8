// Bolt, washers, nut and members of a joint: sizes as the file says, each on the next, none inside another.
#pragma once

#include "content/format/assembly.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"
#include "tools/author/geometry/wrench.hpp"

namespace bolt::geometry {

// False if the joint has no nut that a wrench could grip. `everything`: all parts, in the assembly's frame.
bool check_stack(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                 const Scene& scene, const Bvh& everything, double jaw, const Messages& messages);

// Room for the wrench: does it fit the nut, can it get there, how far does it swing.

void check_wrench(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                  const Scene& scene, const Wrench& wrench, const Messages& messages);

}  // namespace bolt::geometry
