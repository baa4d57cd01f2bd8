// A part as triangles whose points are those of its B-rep: neighbouring faces share the points of their
// common edge exactly, so that the mesh is as closed as the shape. Scene frame, metres, relative to the part.
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::step_import {

struct Deflection {
    double length_mm = 0.1;  // chord against curve or surface
    double angle = 0.26;     // rad, between neighbouring chords
};

struct FaceMesh {
    std::vector<std::uint32_t> points;  // of each corner of this face: index into PartMesh::points
    std::vector<Vec3> normals;          // of the surface, outward; as many
    std::vector<Vec3> tangents;         // across the lay of a machined surface; as many
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into points and normals of this face
};

struct PartMesh {
    std::vector<Vec3> points;
    std::vector<FaceMesh> faces;                 // as faces_of() numbers them, from 0
    std::vector<std::size_t> without_triangles;  // faces that the mesher gave up on
    double deviation = 0.0;  // m, largest distance found between a triangle and its surface
};

PartMesh tessellate(const TopoDS_Shape& shape, const Deflection& deflection);

std::size_t count_triangles(const PartMesh& mesh);

}  // namespace bolt::step_import
