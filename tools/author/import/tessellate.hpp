// Triangulates a B-rep part. Neighbouring faces share the points of their common edge exactly, so that the
// mesh is as closed as the shape. Scene frame, metres, relative to the part.
#pragma once

#include <TopoDS_Shape.hxx>
#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::step_import {

struct Deflection {
    double length_mm = 0.1;  // largest distance between chord and curve or surface
    double angle = 0.26;     // rad, largest angle between neighbouring chords
};

struct FaceMesh {
    std::vector<std::uint32_t> points;  // for each corner of this face, its index into PartMesh::points
    std::vector<Vec3> normals;          // for each corner, the outward normal of the surface
    std::vector<Vec3> tangents;         // for each corner, the direction across the lay of a machined surface
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of corners
};

struct PartMesh {
    std::vector<Vec3> points;
    std::vector<FaceMesh> faces;                 // in the order of faces_of(), from 0
    std::vector<std::size_t> without_triangles;  // faces that the mesher failed on
    double deviation = 0.0;  // m, largest distance found between a triangle and its surface
};

PartMesh tessellate(const TopoDS_Shape& shape, const Deflection& deflection);

std::size_t count_triangles(const PartMesh& mesh);

}  // namespace bolt::step_import
