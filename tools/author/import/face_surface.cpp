#include "tools/author/import/face_surface.hpp"

#include <algorithm>

#include "tools/author/import/frame.hpp"

namespace bolt::step_import {

FaceSurface::FaceSurface(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation)
    : surface_(face, false), side_(face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0) {
    for (int i = 1; i <= triangulation->NbNodes(); ++i) add(triangulation->UVNode(i).XY());
}

void FaceSurface::add(const gp_XY& uv) {
    gp_Pnt point;
    gp_Vec du, dv;
    surface_.D1(uv.X(), uv.Y(), point, du, dv);
    constexpr double vanishing = 1e-9;  // against the other derivative
    uv_.push_back(uv);
    pole_u_.push_back(du.Magnitude() < vanishing * dv.Magnitude());
    pole_v_.push_back(dv.Magnitude() < vanishing * du.Magnitude());
}

gp_XY FaceSurface::at(std::uint32_t corner, const gp_XY& towards) const {
    return {pole_u_[corner] ? towards.X() : uv_[corner].X(), pole_v_[corner] ? towards.Y() : uv_[corner].Y()};
}

gp_XY FaceSurface::middle(std::uint32_t a, std::uint32_t b) const {
    return (at(a, uv_[b]) + at(b, uv_[a])) * 0.5;
}

gp_XY FaceSurface::middle(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return (at(a, (uv_[b] + uv_[c]) * 0.5) + at(b, (uv_[c] + uv_[a]) * 0.5) +
            at(c, (uv_[a] + uv_[b]) * 0.5)) /
           3.0;
}

Vec3 FaceSurface::point(const gp_XY& uv) const {
    return point_to_scene(surface_.Value(uv.X(), uv.Y()).XYZ());
}

Vec3 FaceSurface::normal(const gp_XY& uv) const {
    gp_Pnt point;
    gp_Vec du, dv;
    surface_.D1(uv.X(), uv.Y(), point, du, dv);
    const gp_Vec cross = du.Crossed(dv);
    const double squared = cross.SquareMagnitude();
    if (squared < 1e-24 || squared < 1e-14 * du.SquareMagnitude() * dv.SquareMagnitude()) return Vec3{0.0};
    return direction_to_scene(cross.Normalized().XYZ()) * side_;
}

double FaceSurface::distance(const gp_XY& uv, const Vec3& p) const {
    const gp_Pnt there(point_to_cad(p));
    gp_Pnt point;
    gp_Vec du, dv;
    surface_.D1(uv.X(), uv.Y(), point, du, dv);
    const gp_Vec off(point, there);
    // One step of Newton's method: enough for points as near as those of a mesh.
    const double uu = du.SquareMagnitude(), vv = dv.SquareMagnitude(), mixed = du.Dot(dv);
    const double pu = off.Dot(du), pv = off.Dot(dv), det = uu * vv - mixed * mixed;
    if (det <= 1e-12 * uu * vv) return off.Magnitude() * mm;
    const gp_Pnt nearer =
        surface_.Value(uv.X() + (pu * vv - pv * mixed) / det, uv.Y() + (pv * uu - pu * mixed) / det);
    return std::min(off.Magnitude(), nearer.Distance(there)) * mm;
}

}  // namespace bolt::step_import
