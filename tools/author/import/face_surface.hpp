// The analytic surface under a meshed face: parameters, normals and distances at the corners of the mesh;
// refinement of the mesh; tangents of machined surfaces. Lengths in metres, scene frame, unless stated
// otherwise.
#pragma once

#include <BRepAdaptor_Surface.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS_Face.hxx>
#include <array>
#include <cstdint>
#include <gp_XY.hxx>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::step_import {

class FaceSurface {
  public:
    // Takes over the corners of the triangulation, in its order.
    FaceSurface(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation);

    // Appends a corner.
    void add(const gp_XY& uv);

    [[nodiscard]] bool is_plane() const { return surface_.GetType() == GeomAbs_Plane; }
    [[nodiscard]] bool is_pole(std::uint32_t corner) const { return pole_u_[corner] || pole_v_[corner]; }
    [[nodiscard]] const gp_XY& at(std::uint32_t corner) const { return uv_[corner]; }
    // At a pole, one point has many parameters; returns the parameters closest to `towards`.
    [[nodiscard]] gp_XY at(std::uint32_t corner, const gp_XY& towards) const;
    [[nodiscard]] gp_XY middle(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] gp_XY middle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

    [[nodiscard]] Vec3 point(const gp_XY& uv) const;  // scene frame, metres
    // Outward unit normal; zero where the surface has none.
    [[nodiscard]] Vec3 normal(const gp_XY& uv) const;
    // Distance of `p` from the surface, m; the search starts at `uv`.
    [[nodiscard]] double distance(const gp_XY& uv, const Vec3& p) const;

  private:
    BRepAdaptor_Surface surface_;
    double orientation_ = 1.0;  // −1 for a reversed face
    std::vector<gp_XY> uv_;
    std::vector<bool> pole_u_, pole_v_;
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Splits triangles inside a face until they are within `deflection` (m) of the surface. The mesher guarantees
// the deflection along edges, but may exceed it by half inside a sphere or a fillet. Edges on the rim of the
// face are not split, so that neighbouring faces still match. Appends to `surface` and `corners` (positions)
// and replaces `triangles`.
void refine(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection);

// Largest distance (m) of the triangles from the surface, sampled in the middle of edges and triangles.
double deviation(const FaceSurface& surface, const std::vector<Vec3>& corners, const Triangles& triangles);

// Returns unit tangents at the corners of a face, perpendicular to the normals and to the lay of the machined
// surface (ISO 21920: the direction of its marks). Anisotropic materials stretch their highlight along the
// tangent, and brushed metal stretches it across the lay. Tangents run along the axis of a turned surface,
// radially outwards on a turned end face, and in one fixed direction on a milled face.
std::vector<Vec3> tangents_across_lay(const TopoDS_Face& face, const std::vector<Vec3>& corners,
                                      const std::vector<Vec3>& normals);

}  // namespace bolt::step_import
