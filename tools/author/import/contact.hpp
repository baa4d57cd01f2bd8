// The contact mesh of a part: its points welded along the B-rep's edges, and where it is not closed.
#pragma once

#include "engine/assets/model.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

struct OpenEdges {
    std::size_t count = 0;
    std::vector<Vec3> first;  // middle of the first ones, m, relative to the part
};

struct ContactMesh {
    assets::Mesh mesh;  // positions and indices only
    std::size_t triangles = 0;
    OpenEdges open;  // none: watertight
};

// A side of a triangle that no other triangle has the other way round is open.
OpenEdges open_edges(const PartMesh& mesh, std::size_t most_listed = 5);

ContactMesh contact_mesh(const PartMesh& mesh, std::string name);

}  // namespace bolt::step_import
