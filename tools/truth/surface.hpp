// Slow and sure answers about closed surfaces, to hold the contact finder and the god-object against: in
// double, by other means than theirs. No normals, no sampling: triangles with triangles, and inside from
// outside by how often the surface winds about a point.
#pragma once

#include "engine/base/pose.hpp"
#include "haptics/contact/mesh.hpp"
#include "haptics/contact/samples.hpp"
#include "tools/geometry/bvh.hpp"

namespace bolt::truth {

// A closed surface, in its own frame.
struct Surface {
    geometry::Bvh tree;
};

Surface make_surface(const contact::ContactMesh& mesh);

// The points that a finder looks at, as triangles without a side: of those it must know the very distance.
geometry::Bvh points_of(const contact::Samples& samples);

struct Foot {
    double distance = 0.0;  // m
    std::uint32_t triangle = 0;
};

// The nearest of the triangles; infinite where none is within `reach`.
Foot nearest(const geometry::Bvh& tree, const Vec3& point, double reach);

double point_triangle(const Vec3& point, const geometry::Triangle& triangle);
// Of triangles that do not cross; they may be lines or points.
double triangle_triangle(const geometry::Triangle& a, const geometry::Triangle& b);

// How many times the surface goes round a point that is not on it: crossings of a ray, counted with their
// direction.
int winding(const Surface& surface, const Vec3& point);

// Below 0 inside; infinite where nothing is within `reach`.
double signed_distance(const Surface& surface, const Vec3& point, double reach);

// Whether two surfaces cross, `b` placed by a pose.
bool cross(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a);

// The least distance of two surfaces that do not cross; `reach` where there is none smaller.
double gap(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a, double reach);

struct Depths {
    double least = 5e-6;      // m: what is not deeper is not looked for
    double enough = 1.0;      // m: what is deeper is told to be at least that
    double tolerance = 1e-6;  // m
};

// How far within `other` the points of a surface lie at most; of what is not deeper than `least`, some of it.
double depth_in(const geometry::Bvh& mine, const Surface& other, const Pose& mine_to_other,
                const Depths& depths);

}  // namespace bolt::truth
