// The near, far and contact meshes of a part, made from its triangulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

// Returns one normal for each index: the area-weighted mean of the normals of those triangles at the same
// position whose normal differs by less than `crease` (rad) from that of the corner's own triangle. Plane
// faces stay plane and edges stay sharp.
std::vector<glm::vec3> crease_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<std::uint32_t>& indices, double crease);

// Builds the near level of a part, one primitive for each material. `faces`: index of each face's material in
// `materials`; anisotropic materials get tangents. Corners of one point whose normals agree within 1.5° share
// a vertex, so that tangent faces blend and edges stay sharp. Omits triangles without area.
assets::Mesh render_mesh(const PartMesh& part, const std::vector<int>& faces,
                         const std::vector<assets::Material>& materials, std::string name);

std::size_t count_triangles(const assets::Mesh& mesh);

struct FarLevel {
    std::vector<assets::Mesh> meshes;  // in the order of the input
    std::size_t triangles = 0;         // counting every instance
    double error = 0.0;                // m, added by the simplification
};

// Simplifies all meshes with one common error until the assembly has at most `budget` triangles or the error
// reaches `max_error` (m). `uses`: number of instances of each mesh. Vertices on both sides of a sharp edge
// or of a material boundary move together, so that no gap opens.
FarLevel simplify(const std::vector<assets::Mesh>& meshes, const std::vector<std::size_t>& uses,
                  std::size_t budget, double max_error);

struct OpenEdgeList {
    std::size_t count = 0;
    std::vector<Vec3> first;  // m, middles of the first edges, relative to the part
};

// The contact mesh of a part; its points are shared along the edges of the B-rep.
struct PartContactMesh {
    assets::Mesh mesh;  // positions and indices only
    std::size_t triangles = 0;
    OpenEdgeList open;  // empty if watertight
};

// Finds the triangle edges without a partner in the opposite direction. Lists at most `max_listed` positions.
OpenEdgeList open_edges(const PartMesh& mesh, std::size_t max_listed = 5);

PartContactMesh contact_mesh(const PartMesh& mesh, std::string name);

}  // namespace bolt::step_import
