// Measurements on solids. Millimetres.
#pragma once

#include <BRepClass3d_SolidClassifier.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Lin.hxx>
#include <vector>

namespace bolt::models {

// Distinct radii of the cylindrical faces about an axis parallel to Z through (x, y), ascending.
std::vector<double> radii(const TopoDS_Shape& shape, double x = 0.0, double y = 0.0);

// Distinct distances between parallel plane faces that are parallel to Z, ascending.
std::vector<double> flat_to_flat(const TopoDS_Shape& shape);

// Parameters along the line at which it crosses the shape, ascending.
std::vector<double> crossings(const TopoDS_Shape& shape, const gp_Lin& line);

// Every `every`-th vertex of a mesh of the shape.
std::vector<gp_Pnt> surface_points(const TopoDS_Shape& shape, double deflection, std::size_t every);

// Measures how deep points are inside a solid. Reuse it: its constructor takes longer than a measurement.
class DepthInside {
  public:
    explicit DepthInside(const TopoDS_Shape& solid);
    // Distance from a point inside the solid to its faces; 0 outside.
    double operator()(const gp_Pnt& point);

  private:
    BRepClass3d_SolidClassifier classifier_;
    TopoDS_Shape shell_;
};

// Triangles of a mesh with these tolerances.
int triangles(const TopoDS_Shape& shape, double deflection, double angle);

struct Extent {
    double x0, y0, z0, x1, y1, z1;
};
Extent extent(const TopoDS_Shape& shape);

// True if one of the values is within the tolerance of `expected`.
bool has(const std::vector<double>& values, double expected, double tolerance = 0.01);

}  // namespace bolt::models
