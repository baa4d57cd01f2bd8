// Each joint's node: there, alone, in its place.
#pragma once

#include <vector>

#include "content/format/assembly.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

// For every joint the scene's node that shows it; -1 where that is not so, which has been said then.
std::vector<int> check_nodes(const content::Assembly& assembly, const Scene& scene, const Messages& messages);

}  // namespace bolt::geometry
