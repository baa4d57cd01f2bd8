// The surface under a meshed face: parameters of the mesh's corners, normals, distances.
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
    // The corners of the triangulation, in its order.
    FaceSurface(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation);

    // Appends a corner.
    void add(const gp_XY& uv);

    [[nodiscard]] bool flat() const { return surface_.GetType() == GeomAbs_Plane; }
    [[nodiscard]] bool pole(std::uint32_t corner) const { return pole_u_[corner] || pole_v_[corner]; }
    [[nodiscard]] const gp_XY& at(std::uint32_t corner) const { return uv_[corner]; }
    // A pole is a point with many parameters: of these, the one beside `towards`.
    [[nodiscard]] gp_XY at(std::uint32_t corner, const gp_XY& towards) const;
    [[nodiscard]] gp_XY middle(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] gp_XY middle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

    [[nodiscard]] Vec3 point(const gp_XY& uv) const;  // scene frame, metres
    // Outward; zero where the surface has none.
    [[nodiscard]] Vec3 normal(const gp_XY& uv) const;
    // Of a point of the scene from the surface, m, looked for near `uv`.
    [[nodiscard]] double distance(const gp_XY& uv, const Vec3& p) const;

  private:
    BRepAdaptor_Surface surface_;
    double side_ = 1.0;
    std::vector<gp_XY> uv_;
    std::vector<bool> pole_u_, pole_v_;
};

// Splits triangles inside a face until they keep the deflection: the mesher keeps it along edges, but may
// miss it by half inside a sphere or a fillet. The sides on the face's rim stay, so that neighbours still
// fit.

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Appends corners to `surface` and `corners` (positions, m) and replaces triangles.
void refine(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection);

// Largest distance (m) of the triangles from their surface, looked at in the middle of sides and triangles.
double deviation(const FaceSurface& surface, const std::vector<Vec3>& corners, const Triangles& triangles);

// The lay of a machined surface (ISO 21920: the direction of its marks), as tangents for anisotropic
// materials. The highlight of brushed metal is drawn out across the lay, so the tangent stands across it:
// along the axis of what was turned, outward on a turned face, one way on a milled one.

// Unit tangents at the corners of a face, perpendicular to the normals; scene frame.
std::vector<Vec3> tangents_across_lay(const TopoDS_Face& face, const std::vector<Vec3>& corners,
                                      const std::vector<Vec3>& normals);

}  // namespace bolt::step_import
