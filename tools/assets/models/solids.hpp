// The CAD operations that all models use. Millimetres.
#pragma once

#include <BRepBuilderAPI_MakeWire.hxx>
#include <TopoDS_Shape.hxx>
#include <functional>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Trsf.hxx>
#include <initializer_list>
#include <vector>

namespace bolt::models {

// An outline in the half plane (radius, z) that is built point by point. face() closes it.
class ProfileOutline {
  public:
    explicit ProfileOutline(gp_Pnt2d start) : start_(start), end_(start) {}
    ProfileOutline& line(gp_Pnt2d to);
    ProfileOutline& arc(gp_Pnt2d through, gp_Pnt2d to);
    [[nodiscard]] TopoDS_Shape face() const;

  private:
    gp_Pnt2d start_, end_;
    mutable BRepBuilderAPI_MakeWire wire_;
};

// Solids of revolution: a full turn about the Z axis.
TopoDS_Shape revolved(const ProfileOutline& profile);
TopoDS_Shape revolved(std::initializer_list<gp_Pnt2d> corners);

// A box between two corners.
TopoDS_Shape box(gp_Pnt low, gp_Pnt high);

// An upright block with rounded vertical edges: its middle is at (x, y), it reaches from z0 to z1.
TopoDS_Shape rounded_block(double x, double y, double length, double width, double corner, double z0,
                           double z1);

TopoDS_Shape cylinder(const gp_Ax2& axis, double radius, double height);
TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by);
gp_Trsf shift(double x, double y, double z);
gp_Trsf turn(const gp_Ax1& about, double angle);

TopoDS_Shape fused(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape fused(const std::vector<TopoDS_Shape>& parts);
TopoDS_Shape cut(const TopoDS_Shape& from, const TopoDS_Shape& what);
TopoDS_Shape cut(const TopoDS_Shape& from, const std::vector<TopoDS_Shape>& what);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);

// Selects edges by their middle point and their direction there.
using EdgeSelector = std::function<bool(const gp_Pnt& middle, const gp_Dir& along)>;

// Rounds or bevels the selected edges. If OpenCASCADE cannot build the rounding, the shape is returned
// unchanged: a model does not fail because of a rounding, and its tests check the roundings that matter.
TopoDS_Shape rounded(const TopoDS_Shape& shape, double radius, const EdgeSelector& select);
TopoDS_Shape bevelled(const TopoDS_Shape& shape, double width, const EdgeSelector& select);

// Joins two solids that touch in a face.
TopoDS_Shape glued(const TopoDS_Shape& a, const TopoDS_Shape& b);

// The only solid in a shape; null if there is none or more than one.
TopoDS_Shape only_solid(const TopoDS_Shape& shape);

// True if the solid is valid (BRepCheck), closed (every edge lies between two faces) and not inside out.
bool is_valid_solid(const TopoDS_Shape& solid);

double volume(const TopoDS_Shape& shape);

}  // namespace bolt::models
