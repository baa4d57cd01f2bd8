#include "tools/author/import/lay.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <gp_Torus.hxx>
#include <optional>

#include "tools/author/import/frame.hpp"

namespace bolt::step_import {

namespace {

struct Axis {
    Vec3 point, direction;
};

Axis to_scene(const gp_Ax1& axis) {
    return {point_to_scene(axis.Location().XYZ()), direction_to_scene(axis.Direction().XYZ())};
}

// Of the largest circle on the rim of a flat face: what it was turned about.
std::optional<Axis> rim(const TopoDS_Face& face) {
    std::optional<Axis> axis;
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

Vec3 any_across(const Vec3& normal) {
    const Vec3 aside = std::abs(normal.x) < 0.8 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 0.0, 1.0};
    return aside - glm::dot(aside, normal) * normal;
}

}  // namespace

std::vector<Vec3> tangents_across_lay(const TopoDS_Face& face, const std::vector<Vec3>& corners,
                                      const std::vector<Vec3>& normals) {
    const BRepAdaptor_Surface surface(face, false);
    std::optional<Axis> axis;
    switch (surface.GetType()) {
        case GeomAbs_Plane:
            axis = rim(face);
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
        // The marks run around the axis; across them, in the surface, is the normal times that.
        if (axis) across = glm::cross(glm::cross(axis->direction, corners[i] - axis->point), normals[i]);
        across -= glm::dot(across, normals[i]) * normals[i];
        if (glm::length(across) < 1e-9) across = any_across(normals[i]);
        tangents.push_back(glm::normalize(across));
    }
    return tangents;
}

}  // namespace bolt::step_import
