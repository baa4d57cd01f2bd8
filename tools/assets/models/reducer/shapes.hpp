// The CAD operations that the reducer uses. Each checks its result and throws a BuildError if it fails.
// Millimetres, Z up.
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

// Thrown inside this folder only. catch_build_errors converts it, and exceptions of OpenCASCADE, to an Error.
struct BuildError {
    std::string what;
};

template <class Build>
auto catch_build_errors(std::string_view part, Build build) -> Result<decltype(build())>;

using Shapes = std::vector<TopoDS_Shape>;

struct BoxLimits {
    double x0, x1, y0, y1, z0, z1;
};

TopoDS_Shape box(const BoxLimits& b);
TopoDS_Shape cylinder(const gp_Ax2& axis, double radius, double length);
TopoDS_Shape cylinder_y(double x, double z, double y0, double y1, double radius);
TopoDS_Shape cylinder_z(double x, double y, double z0, double z1, double radius);
// Revolves a closed outline of points (radius, distance along the axis) about the axis.
TopoDS_Shape revolved(const gp_Ax2& axis, const std::vector<std::pair<double, double>>& outline);
TopoDS_Shape extruded(const TopoDS_Wire& outline, const gp_Vec& along);
TopoDS_Wire polygon(const std::vector<gp_Pnt>& points);
// A rectangle with rounded corners in the XY plane of `frame`, centred on its origin.
TopoDS_Wire rounded_rectangle(const gp_Ax2& frame, double length, double width, double radius);
// The outline of the convex hull of two circles in the plane y.
TopoDS_Wire hull_y(double y, double x0, double z0, double r0, double x1, double z1, double r1);

TopoDS_Shape fused(const Shapes& parts);
TopoDS_Shape cut(const TopoDS_Shape& body, const Shapes& tools);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape merged_faces(const TopoDS_Shape& shape);  // coplanar and coaxial neighbours become one face
TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by);
TopoDS_Shape mirrored_y(const TopoDS_Shape& shape);
TopoDS_Shape mirrored_z(const TopoDS_Shape& shape);

using EdgePredicate = std::function<bool(const TopoDS_Edge&)>;
gp_Pnt middle(const TopoDS_Edge& edge);
bool in_plane_z(const TopoDS_Edge& edge, double z);

// Rounds, or chamfers, every picked edge. Picking none is an error.
TopoDS_Shape filleted(std::string_view name, const TopoDS_Shape& shape, double radius,
                      const EdgePredicate& pick);
TopoDS_Shape chamfered(std::string_view name, const TopoDS_Shape& shape, double width,
                       const EdgePredicate& pick);
// Joins two solids and rounds the edges where they meet, except those for which `skip` is true.
TopoDS_Shape blended(std::string_view name, const TopoDS_Shape& body, const TopoDS_Shape& addition,
                     double radius, const EdgePredicate& skip = {});

double volume(const TopoDS_Shape& shape);
// Throws unless the shape is one closed valid solid.
TopoDS_Shape one_solid(std::string_view name, const TopoDS_Shape& shape);

Error build_error(std::string_view part, const std::string& what);
// Describes the exception in flight; call it in a catch block. Rethrows exceptions that are neither
// BuildError nor from OpenCASCADE.
std::string current_failure();

template <class Build>
auto catch_build_errors(std::string_view part, Build build) -> Result<decltype(build())> {
    try {
        return build();
    } catch (...) {
        return fail(build_error(part, current_failure()));
    }
}

}  // namespace bolt::models::reducer
