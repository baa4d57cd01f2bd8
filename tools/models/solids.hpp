// The few operations that all models are made of. Millimetres.
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

// An outline in the half plane (radius, z), drawn point by point and closed by itself.
class Profile {
  public:
    explicit Profile(gp_Pnt2d start) : start_(start), end_(start) {}
    Profile& line(gp_Pnt2d to);
    Profile& arc(gp_Pnt2d through, gp_Pnt2d to);
    [[nodiscard]] TopoDS_Shape face() const;

  private:
    gp_Pnt2d start_, end_;
    mutable BRepBuilderAPI_MakeWire wire_;
};

// A full turn about the Z axis.
TopoDS_Shape revolved(const Profile& profile);
TopoDS_Shape revolved(std::initializer_list<gp_Pnt2d> corners);

// A box between two corners.
TopoDS_Shape box(gp_Pnt low, gp_Pnt high);

// A rectangle with rounded corners, middle at (x, y), from z0 to z1.
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

// Rounds or bevels the edges that `which` takes (by the edge's middle point and direction there). The shape
// as it was if the edges cannot take the radius: a model never fails over a rounding, its tests say what must
// be round.
using EdgeChoice = std::function<bool(const gp_Pnt& middle, const gp_Dir& along)>;
TopoDS_Shape rounded(const TopoDS_Shape& shape, double radius, const EdgeChoice& which);
TopoDS_Shape bevelled(const TopoDS_Shape& shape, double width, const EdgeChoice& which);

// Two solids that touch in a face become one; faces that continue each other are joined.
TopoDS_Shape glued(const TopoDS_Shape& a, const TopoDS_Shape& b);

// The one solid in a shape; null if there are none or several.
TopoDS_Shape only_solid(const TopoDS_Shape& shape);

// Valid (BRepCheck), closed (every edge between two faces) and right side out.
bool is_sound(const TopoDS_Shape& solid);

double volume(const TopoDS_Shape& shape);

}  // namespace bolt::models
