// Triangles in double precision, and what can be said about them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::sculpt {

using Triangle = std::array<std::uint32_t, 3>;

struct TriMesh {
    std::vector<Vec3> positions;
    std::vector<Triangle> triangles;
};

// Signed; positive when the triangles of a closed mesh look outward (counter-clockwise).
double volume(const TriMesh& mesh);

// Twice the area times the unit normal.
Vec3 area_vector(const TriMesh& mesh, const Triangle& triangle);

// Directed edges without exactly one opposite: none in a closed, oriented two-manifold.
std::size_t open_edges(const TriMesh& mesh);

// Vertices at the same place (bit for bit) become one; triangles that collapse are dropped.
TriMesh weld(const TriMesh& mesh);

// Moves vertices towards the centre of their neighbours, in the tangent plane given by the area-weighted
// normals.
void relax_tangentially(TriMesh& mesh, double strength);

}  // namespace bolt::sculpt
