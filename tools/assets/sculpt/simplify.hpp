// Fewer triangles where the surface is flat (meshoptimizer's quadrics), keeping the lines between labels.
#pragma once

#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt {

struct LabelledMesh {
    TriMesh mesh;
    std::vector<int> labels;  // one a triangle
};

// Vertices of the result are vertices of the input. `target` triangles at most, unless topology forbids.
LabelledMesh simplify(const LabelledMesh& fine, std::size_t target);

}  // namespace bolt::sculpt
