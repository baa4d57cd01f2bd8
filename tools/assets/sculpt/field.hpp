// Signed distance fields and the extraction of their surface. Metres, negative inside. The primitives are
// exact, or bounds that are exact at the surface, so that blends keep their stated width.
#pragma once

#include <functional>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt {

using SignedDistanceField = std::function<double(const Vec3&)>;

// The distance to the convex hull of two spheres.
double round_cone(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a, double radius_b);

// An ellipsoid centred at the origin with its axes along the coordinate axes.
double ellipsoid(const Vec3& p, const Vec3& radii);

// A box centred at the origin with rounded edges. The half sizes include the rounding.
double rounded_box(const Vec3& p, const Vec3& half, double radius);

// Polynomial blends: the result differs from min or max only where both are within k of each other.
double smooth_union(double a, double b, double k);
double smooth_intersection(double a, double b, double k);
double smooth_difference(double a, double b, double k);

// The cubic step from 0 at `low` to 1 at `high`.
double smooth_step(double low, double high, double x);

// Estimates the gradient from four samples at the corners of a tetrahedron of size h (m).
Vec3 gradient(const SignedDistanceField& field, const Vec3& p, double h);

// Moves p towards the zero surface by at most `steps` Newton steps. `h`: m, size for gradient().
Vec3 project(const SignedDistanceField& field, Vec3 p, double h, int steps);

struct FieldBounds {
    Vec3 low, high;
};

// Extracts the zero surface as triangles with cells of size `cell` (m): naive surface nets (S. F. Gibson,
// MERL TR99-24). Each vertex is then projected onto the surface, and `relaxations` steps spread the vertices
// evenly. The surface must lie inside the box. The field's slope must not exceed 2, because a block of cells
// is skipped by the value at its centre.
TriMesh extract(const SignedDistanceField& field, const FieldBounds& box, double cell, int relaxations = 3);

}  // namespace bolt::sculpt
