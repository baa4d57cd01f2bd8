// What is drawn of a part: one primitive a material, vertices shared where the surface goes on smoothly.
#pragma once

#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

// `faces`: the material of each face; `materials`: what those are. Anisotropic ones get tangents. Corners of
// one point become one vertex where their normals agree within 1.5°, so that tangent faces flow into each
// other and edges stay hard. Triangles without area are left out.
assets::Mesh render_mesh(const PartMesh& part, const std::vector<int>& faces,
                         const std::vector<assets::Material>& materials, std::string name);

std::size_t count_triangles(const assets::Mesh& mesh);

}  // namespace bolt::step_import
