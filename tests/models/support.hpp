// What the tests of the models measure on a solid. Millimetres.
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Lin.hxx>
#include <vector>

namespace bolt::models {

// Radii of the cylindrical faces around an axis parallel to Z through (x, y), without doubles, ascending.
std::vector<double> radii(const TopoDS_Shape& shape, double x = 0.0, double y = 0.0);

// Distances between parallel plane faces that stand on Z (both ways), without doubles, ascending.
std::vector<double> flat_to_flat(const TopoDS_Shape& shape);

// Where a line goes in and out of the shape, as parameters along it.
std::vector<double> crossings(const TopoDS_Shape& shape, const gp_Lin& line);

// Points on the faces of a shape, from its mesh.
std::vector<gp_Pnt> surface_points(const TopoDS_Shape& shape, double deflection, std::size_t every);

// How far a point lies inside a solid, by the solid's own faces; 0 outside.
double depth_inside(const TopoDS_Shape& solid, const gp_Pnt& point);

int triangles(const TopoDS_Shape& shape, double deflection, double angle);

struct Extent {
    double x0, y0, z0, x1, y1, z1;
};
Extent extent(const TopoDS_Shape& shape);

bool has(const std::vector<double>& values, double wanted, double tolerance = 0.01);

}  // namespace bolt::models
