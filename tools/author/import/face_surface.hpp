// The surface under a meshed face: parameters of the mesh's corners, normals, distances.
#pragma once

#include <BRepAdaptor_Surface.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS_Face.hxx>
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

}  // namespace bolt::step_import
