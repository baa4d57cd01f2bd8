// Triangle meshes in double precision: measures, welding, relaxation, cutting and simplification.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::sculpt {

using IndexTriangle = std::array<std::uint32_t, 3>;

struct TriMesh {
    std::vector<Vec3> positions;
    std::vector<IndexTriangle> triangles;
};

// Returns the signed volume; positive if the triangles of a closed mesh face outward (counter-clockwise).
double volume(const TriMesh& mesh);

// Returns twice the area times the unit normal.
Vec3 area_vector(const TriMesh& mesh, const IndexTriangle& triangle);

// Counts the directed edges without exactly one opposite edge; 0 for a closed, oriented two-manifold.
std::size_t open_edges(const TriMesh& mesh);

// Merges vertices with identical coordinates and drops triangles that become degenerate.
TriMesh weld(const TriMesh& mesh);

// Moves vertices towards the centre of their neighbours within the tangent plane of their area-weighted
// normal. `strength` 1 moves all the way.
void relax_tangentially(TriMesh& mesh, double strength);

// Splits triangles along the zero line of `value`, so that the border between two materials is a smooth
// curve. Afterwards no triangle contains the line in its interior. Vertices close to the line are moved onto
// it to avoid slivers.
void cut(TriMesh& mesh, const std::function<double(const Vec3&)>& value);

struct LabelledMesh {
    TriMesh mesh;
    std::vector<int> labels;  // one per triangle
};

// Simplifies a mesh to at most `target` triangles, unless topology prevents that, and keeps the lines between
// labels (meshoptimizer's quadrics). The result uses vertices of the input.
LabelledMesh simplify(const LabelledMesh& fine, std::size_t target);

}  // namespace bolt::sculpt
