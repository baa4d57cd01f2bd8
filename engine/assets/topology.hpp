// Triangles of any topology, and where nodes are in the world.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/assets/model.hpp"

namespace bolt::assets {

// Three vertex indices a triangle, wound as glTF winds strips and fans; empty for points and lines.
std::vector<std::uint32_t> triangle_indices(const Primitive& primitive);

glm::mat4 local_transform(const Node& node);

// Of every node, in the order of model.nodes; nodes outside the scene count from the scene's origin.
std::vector<glm::mat4> world_transforms(const Model& model);

}  // namespace bolt::assets
