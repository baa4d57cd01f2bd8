// Signed distance fields: what clay is to a sculptor. Negative inside; metres. The primitives are exact or
// bounds that are exact at the surface, so that blends keep their stated width.
#pragma once

#include <functional>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt {

inline constexpr double mm = 1e-3;

using Field = std::function<double(const Vec3&)>;

// The convex hull of two spheres.
double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b);

// Axes along the coordinates, centre at the origin.
double ellipsoid(const Vec3& p, const Vec3& radii);

// A box with rounded edges; half sizes include the rounding.
double rounded_box(const Vec3& p, const Vec3& half, double radius);

// Polynomial blends: the result differs from min or max only where both are within k of each other.
double smooth_union(double a, double b, double k);
double smooth_intersection(double a, double b, double k);
double smooth_difference(double a, double b, double k);

double smooth_step(double low, double high, double x);

// From four samples at the corners of a tetrahedron of size h.
Vec3 gradient(const Field& field, const Vec3& p, double h);

// Newton steps onto the zero surface.
Vec3 project(const Field& field, Vec3 p, double h, int steps);

// The zero surface of a field as triangles: naive surface nets (S. F. Gibson, MERL TR99-24), each vertex then
// brought onto the surface and spread evenly along it.

struct Box {
    Vec3 low, high;
};

// The surface must lie inside the box and the field must not fall faster than twice the distance: blocks of
// cells are passed over on the word of their centre.
TriMesh extract(const Field& field, const Box& box, double cell, int relaxations = 3);

}  // namespace bolt::sculpt
