// The tree with one mesh a shape, as a glTF model.
#pragma once

#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/tree.hpp"

namespace bolt::step_import {

// `meshes`: by TreeNode::shape; one without primitives leaves its nodes empty.
assets::Model make_model(const Tree& tree, const std::vector<assets::Mesh>& meshes,
                         const std::vector<assets::Material>& materials);

}  // namespace bolt::step_import
