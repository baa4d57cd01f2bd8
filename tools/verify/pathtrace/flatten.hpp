// Resolves nodes, skins and morph targets of a model at rest into triangles and lights in the world frame.
#pragma once

#include <string_view>
#include <vector>

#include "tools/verify/pathtrace/scene.hpp"

namespace bolt::pathtrace {

struct FlatMesh {
    std::vector<Vertex> vertices;
    std::vector<TracedTriangle> triangles;
    std::vector<PunctualLight> lights;
};

// Material indices are those of the model; the index model.materials.size() means no material.
FlatMesh flatten(const assets::Model& model, const NodeFilter& visibility);

// Returns whether a name matches a pattern in which * stands for any text and ? for any character.
bool matches(std::string_view pattern, std::string_view name);

}  // namespace bolt::pathtrace
