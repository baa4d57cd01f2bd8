// The few CAD operations that the reducer is made of, each checked: one that fails throws, it is never
// skipped. Millimetres, Z up.
#pragma once

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Wire.hxx>
#include <functional>
#include <gp_Ax2.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::models::reducer {

// Thrown inside this folder only, as OpenCASCADE throws its own; `guarded` turns both into an Error.
struct BuildError {
    std::string what;
};

template <class Build>
auto guarded(std::string_view part, Build build) -> Result<decltype(build())>;

using Shapes = std::vector<TopoDS_Shape>;

struct Box {
    double x0, x1, y0, y1, z0, z1;
};

TopoDS_Shape box(const Box& b);
TopoDS_Shape cylinder(const gp_Ax2& axis, double radius, double length);
TopoDS_Shape cylinder_y(double x, double z, double y0, double y1, double radius);
TopoDS_Shape cylinder_z(double x, double y, double z0, double z1, double radius);
// A closed outline of (radius, along) points turned about an axis; along the axis' direction.
TopoDS_Shape revolved(const gp_Ax2& axis, const std::vector<std::pair<double, double>>& outline);
TopoDS_Shape extruded(const TopoDS_Wire& outline, const gp_Vec& along);
TopoDS_Wire polygon(const std::vector<gp_Pnt>& points);
// A rectangle with rounded corners in the plane of `frame`, about its origin.
TopoDS_Wire rounded_rectangle(const gp_Ax2& frame, double length, double width, double radius);
// The outline of the convex hull of two circles in the plane y = const.
TopoDS_Wire hull_y(double y, double x0, double z0, double r0, double x1, double z1, double r1);

TopoDS_Shape fused(const Shapes& parts);
TopoDS_Shape cut(const TopoDS_Shape& body, const Shapes& tools);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape merged_faces(const TopoDS_Shape& shape);  // coplanar and coaxial neighbours become one face
TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by);
TopoDS_Shape mirrored_y(const TopoDS_Shape& shape);
TopoDS_Shape mirrored_z(const TopoDS_Shape& shape);

using PickEdge = std::function<bool(const TopoDS_Edge&)>;
gp_Pnt middle(const TopoDS_Edge& edge);
gp_Pnt middle(const TopoDS_Face& face);
bool in_plane_z(const TopoDS_Edge& edge, double z);

// Rounds every picked edge; it is an error if none is picked.
TopoDS_Shape filleted(std::string_view name, const TopoDS_Shape& shape, double radius, const PickEdge& pick);
TopoDS_Shape chamfered(std::string_view name, const TopoDS_Shape& shape, double width, const PickEdge& pick);
// Joins two solids and rounds the edges where they meet, but for those that `skip` names.
TopoDS_Shape blended(std::string_view name, const TopoDS_Shape& body, const TopoDS_Shape& addition,
                     double radius, const PickEdge& skip = {});

double volume(const TopoDS_Shape& shape);
// Throws unless the shape is one closed valid solid.
TopoDS_Shape one_solid(std::string_view name, const TopoDS_Shape& shape);

Error build_error(std::string_view part, const std::string& what);
std::string
current_failure();  // what is being thrown, to be called in a catch block; rethrows what is not ours

template <class Build>
auto guarded(std::string_view part, Build build) -> Result<decltype(build())> {
    try {
        return build();
    } catch (...) {
        return fail(build_error(part, current_failure()));
    }
}

}  // namespace bolt::models::reducer
