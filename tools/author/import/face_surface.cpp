#include "tools/author/import/face_surface.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Torus.hxx>
#include <map>
#include <optional>
#include <utility>

#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

FaceSurface::FaceSurface(const TopoDS_Face& face, const Handle(Poly_Triangulation) & triangulation)
    : surface_(face, false), orientation_(face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0) {
    for (int i = 1; i <= triangulation->NbNodes(); ++i) add(triangulation->UVNode(i).XY());
}

void FaceSurface::add(const gp_XY& uv) {
    gp_Pnt point;
    gp_Vec du, dv;
    surface_.D1(uv.X(), uv.Y(), point, du, dv);
    constexpr double vanishing = 1e-9;  // ratio to the other derivative
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
    return direction_to_scene(cross.Normalized().XYZ()) * orientation_;
}

double FaceSurface::distance(const gp_XY& uv, const Vec3& p) const {
    const gp_Pnt given(point_to_cad(p));
    gp_Pnt point;
    gp_Vec du, dv;
    surface_.D1(uv.X(), uv.Y(), point, du, dv);
    const gp_Vec off(point, given);
    // One Newton step is enough, because the points of a mesh are close to the surface.
    const double uu = du.SquareMagnitude(), vv = dv.SquareMagnitude(), mixed = du.Dot(dv);
    const double pu = off.Dot(du), pv = off.Dot(dv), det = uu * vv - mixed * mixed;
    if (det <= 1e-12 * uu * vv) return off.Magnitude() * mm;
    const gp_Pnt nearer =
        surface_.Value(uv.X() + (pu * vv - pv * mixed) / det, uv.Y() + (pv * uu - pu * mixed) / det);
    return std::min(off.Magnitude(), nearer.Distance(given)) * mm;
}

namespace {

using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;
using TriangleIndices = std::array<std::uint32_t, 3>;

constexpr int max_passes = 6;  // each pass removes three quarters of the deviation

EdgeKey edge_key(std::uint32_t a, std::uint32_t b) { return std::minmax(a, b); }

class Refiner {
  public:
    Refiner(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection)
        : surface_(surface), corners_(corners), triangles_(triangles), deflection_(deflection) {}

    bool pass() {
        uses_.clear();
        split_.clear();
        for (const TriangleIndices& t : triangles_)
            for (std::size_t k = 0; k < 3; ++k) ++uses_[edge_key(t[k], t[(k + 1) % 3])];
        for (const auto& [ab, count] : uses_)
            if (count == 2 && edge_exceeds(ab)) mark(ab);
        std::vector<bool> centre(triangles_.size(), false);
        bool any = !split_.empty();
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            const TriangleIndices t = triangles_[i];
            if (is_marked(t) || !centre_exceeds(t)) continue;
            any = true;
            if (!mark_longest(t)) centre[i] = true;
        }
        if (any) rebuild(centre);
        return any;
    }

  private:
    FaceSurface& surface_;
    std::vector<Vec3>& corners_;
    Triangles& triangles_;
    double deflection_;
    std::map<EdgeKey, int> uses_;
    std::map<EdgeKey, std::uint32_t> split_;  // the new corner in the middle of each split edge

    bool edge_exceeds(const EdgeKey& ab) const {
        const Vec3 chord = 0.5 * (corners_[ab.first] + corners_[ab.second]);
        return surface_.distance(surface_.middle(ab.first, ab.second), chord) > deflection_;
    }

    bool centre_exceeds(const TriangleIndices& t) const {
        const Vec3 middle = (corners_[t[0]] + corners_[t[1]] + corners_[t[2]]) / 3.0;
        return surface_.distance(surface_.middle(t[0], t[1], t[2]), middle) > deflection_;
    }

    bool is_marked(const TriangleIndices& t) const {
        return split_.contains(edge_key(t[0], t[1])) || split_.contains(edge_key(t[1], t[2])) ||
               split_.contains(edge_key(t[2], t[0]));
    }

    std::uint32_t add(const gp_XY& uv) {
        surface_.add(uv);
        corners_.push_back(surface_.point(uv));
        return static_cast<std::uint32_t>(corners_.size() - 1);
    }

    void mark(const EdgeKey& ab) { split_[ab] = add(surface_.middle(ab.first, ab.second)); }

    bool mark_longest(const TriangleIndices& t) {
        EdgeKey longest{0, 0};
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const EdgeKey ab = edge_key(t[k], t[(k + 1) % 3]);
            const double length = glm::length(corners_[ab.first] - corners_[ab.second]);
            if (uses_[ab] != 2 || length <= most) continue;
            longest = ab;
            most = length;
        }
        if (most > 0.0) mark(longest);
        return most > 0.0;
    }

    void rebuild(const std::vector<bool>& centre) {
        const Triangles old = std::exchange(triangles_, {});
        for (std::size_t i = 0; i < old.size(); ++i) {
            const TriangleIndices& t = old[i];
            if (centre[i]) {
                const std::uint32_t m = add(surface_.middle(t[0], t[1], t[2]));
                for (std::size_t k = 0; k < 3; ++k) triangles_.push_back({t[k], t[(k + 1) % 3], m});
            } else {
                divide(t);
            }
        }
    }

    // Divides a triangle at each of its split edges, recursively.
    void divide(const TriangleIndices& t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
            const auto found = split_.find(edge_key(a, b));
            if (found == split_.end()) continue;
            divide({a, found->second, c});
            divide({found->second, b, c});
            return;
        }
        triangles_.push_back(t);
    }
};

}  // namespace

void refine(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection) {
    if (surface.is_plane()) return;
    Refiner refiner(surface, corners, triangles, deflection);
    for (int i = 0; i < max_passes && refiner.pass(); ++i) {
    }
}

double deviation(const FaceSurface& surface, const std::vector<Vec3>& corners, const Triangles& triangles) {
    if (surface.is_plane()) return 0.0;
    double largest = 0.0;
    for (const auto& [a, b, c] : triangles) {
        const Vec3 middle = (corners[a] + corners[b] + corners[c]) / 3.0;
        largest = std::max(largest, surface.distance(surface.middle(a, b, c), middle));
        for (const auto& [i, k] : {EdgeKey{a, b}, EdgeKey{b, c}, EdgeKey{c, a}})
            largest =
                std::max(largest, surface.distance(surface.middle(i, k), 0.5 * (corners[i] + corners[k])));
    }
    return largest;
}

namespace {

struct RevolutionAxis {
    Vec3 point, direction;
};

RevolutionAxis to_scene(const gp_Ax1& axis) {
    return {point_to_scene(axis.Location().XYZ()), direction_to_scene(axis.Direction().XYZ())};
}

// Axis of the largest circle on the rim of a plane face, taken as the axis about which the face was turned;
// nullopt without a circle.
std::optional<RevolutionAxis> rim_axis(const TopoDS_Face& face) {
    std::optional<RevolutionAxis> axis;
    double largest = 0.0;
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
        const BRepAdaptor_Curve curve(TopoDS::Edge(at.Current()));
        if (curve.GetType() != GeomAbs_Circle || curve.LastParameter() - curve.FirstParameter() < pi)
            continue;
        const gp_Circ circle = curve.Circle();
        if (circle.Radius() <= largest) continue;
        largest = circle.Radius();
        axis = to_scene(circle.Axis());
    }
    return axis;
}

Vec3 any_perpendicular(const Vec3& normal) {
    const Vec3 aside = std::abs(normal.x) < 0.8 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 0.0, 1.0};
    return aside - glm::dot(aside, normal) * normal;
}

}  // namespace

std::vector<Vec3> tangents_across_lay(const TopoDS_Face& face, const std::vector<Vec3>& corners,
                                      const std::vector<Vec3>& normals) {
    const BRepAdaptor_Surface surface(face, false);
    std::optional<RevolutionAxis> axis;
    switch (surface.GetType()) {
        case GeomAbs_Plane:
            axis = rim_axis(face);
            break;
        case GeomAbs_Cylinder:
            axis = to_scene(surface.Cylinder().Axis());
            break;
        case GeomAbs_Cone:
            axis = to_scene(surface.Cone().Axis());
            break;
        case GeomAbs_Torus:
            axis = to_scene(surface.Torus().Axis());
            break;
        case GeomAbs_SurfaceOfRevolution:
            axis = to_scene(surface.AxeOfRevolution());
            break;
        default:
            break;
    }
    std::vector<Vec3> tangents;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Vec3 across{0.0};
        // The marks run around the axis; their cross product with the normal lies in the surface across them.
        if (axis) across = glm::cross(glm::cross(axis->direction, corners[i] - axis->point), normals[i]);
        across -= glm::dot(across, normals[i]) * normals[i];
        if (glm::length(across) < 1e-9) across = any_perpendicular(normals[i]);
        tangents.push_back(glm::normalize(across));
    }
    return tangents;
}

}  // namespace bolt::step_import
