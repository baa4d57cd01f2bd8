// Resolves nodes, skins and morph targets: the triangles of a model at rest, in the world frame.
#pragma once

#include <vector>

#include "tools/verify/pathtrace/scene.hpp"

namespace bolt::pathtrace {

struct Flat {
    std::vector<Vertex> vertices;
    std::vector<Triangle> triangles;
    std::vector<PunctualLight> lights;
};

// Materials are those of the model; one more, model.materials.size(), stands for none.
Flat flatten(const assets::Model& model, const Visibility& visibility);

// Whether a name matches a pattern in which * is any text and ? any character.
bool matches(const std::string& name, const std::string& pattern);

}  // namespace bolt::pathtrace
