// Room for the wrench: does it fit the nut, can it get there, how far does it swing.
#pragma once

#include "content/format/assembly.hpp"
#include "tools/author/geometry/joint_parts.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/wrench.hpp"

namespace bolt::geometry {

void check_wrench(const content::AssemblyJoint& joint, std::size_t index, const JointParts& parts,
                  const Scene& scene, const Wrench& wrench, const Messages& messages);

}  // namespace bolt::geometry
