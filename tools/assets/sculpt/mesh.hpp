// Triangles in double precision, and what can be said about them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
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

// Cutting a mesh along the zero line of a value at its vertices, so that the border between two materials is
// a smooth curve and not a saw.

// Afterwards no triangle has the line inside. Vertices close to the line move onto it instead of leaving
// slivers.
void cut(TriMesh& mesh, const std::function<double(const Vec3&)>& value);

// Fewer triangles where the surface is flat (meshoptimizer's quadrics), keeping the lines between labels.

struct LabelledMesh {
    TriMesh mesh;
    std::vector<int> labels;  // one a triangle
};

// Vertices of the result are vertices of the input. `target` triangles at most, unless topology forbids.
LabelledMesh simplify(const LabelledMesh& fine, std::size_t target);

}  // namespace bolt::sculpt
