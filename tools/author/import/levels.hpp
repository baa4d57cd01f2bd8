// Normals made from triangles alone, for meshes that no longer lie on their surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

// A normal for every corner (as many as indices): the mean, weighted by area, of the triangles around the
// corner's place that turn by less than `crease` (rad) against its own. Large flats stay flat, edges stay
// hard.
std::vector<glm::vec3> crease_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<std::uint32_t>& indices, double crease);

// What is drawn of a part: one primitive a material, vertices shared where the surface goes on smoothly.

// `faces`: the material of each face; `materials`: what those are. Anisotropic ones get tangents. Corners of
// one point become one vertex where their normals agree within 1.5°, so that tangent faces flow into each
// other and edges stay hard. Triangles without area are left out.
assets::Mesh render_mesh(const PartMesh& part, const std::vector<int>& faces,
                         const std::vector<assets::Material>& materials, std::string name);

std::size_t count_triangles(const assets::Mesh& mesh);

// The far level: meshes simplified by one common error until the whole assembly fits its budget.

struct FarLevel {
    std::vector<assets::Mesh> meshes;  // as given, simplified
    std::size_t triangles = 0;         // counting uses
    double error = 0.0;                // m, that simplifying has added
};

// `uses`: how often each mesh is placed. Both sides of a hard edge, and of where two materials
// meet, move together, so that no gap opens. The error stops at `most_error` (m) even where the budget is not
// met.
FarLevel simplify(const std::vector<assets::Mesh>& meshes, const std::vector<std::size_t>& uses,
                  std::size_t budget, double most_error);

// The contact mesh of a part: its points welded along the B-rep's edges, and where it is not closed.

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
