// Helpers of the sculpt tests: the hands, which are generated once, and conversions of their meshes.
#pragma once

#include "engine/assets/model.hpp"
#include "tools/assets/sculpt/hand.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt::test {

const HandModels& hands();
const HandShape& shape();

// Returns all primitives of the first mesh as one mesh with identical vertices merged.
TriMesh joined(const assets::Model& model);
// The same without merging: vertex i is vertex i of the primitives in their order.
TriMesh as_stored(const assets::Model& model);

}  // namespace bolt::sculpt::test
