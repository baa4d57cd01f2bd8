// What the tests of the sculptor share: the hands, made once, and measures on them.
#pragma once

#include "engine/assets/model.hpp"
#include "tools/assets/sculpt/hand.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt::test {

const Hands& hands();
const HandShape& shape();

// All primitives of the first mesh in one, vertices at the same place joined.
TriMesh joined(const assets::Model& model);
// The same before joining: vertex i of it is vertex i of the primitives in their order.
TriMesh as_stored(const assets::Model& model);

}  // namespace bolt::sculpt::test
