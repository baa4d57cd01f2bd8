// Triangulation of primitives, and node transforms.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/assets/model.hpp"

namespace bolt::assets {

// Returns three vertex indices per triangle, wound as glTF defines for strips and fans; empty for points and
// lines.
std::vector<std::uint32_t> triangle_indices(const Primitive& primitive);

glm::mat4 local_transform(const Node& node);

// Returns the world transforms of all nodes in the order of model.nodes; nodes outside the scene are relative
// to its origin.
std::vector<glm::mat4> world_transforms(const Model& model);

}  // namespace bolt::assets
