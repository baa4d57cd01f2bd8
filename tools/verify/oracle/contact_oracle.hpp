// Exact answers about closed surfaces, against which contact queries and the god-object are checked: all
// triangles, in double precision, without normals or samples. It uses nothing of haptics/collision. A tree of
// boxes only leaves out triangles that cannot change the answer; tests/contact_validation/surface.cpp
// compares it with plain loops over all triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"

namespace bolt::contact_oracle {

// A closed surface in its own frame (m); triangles run anticlockwise seen from outside. Several closed
// surfaces may overlap.
struct Surface {
    geometry::Bvh tree;
};

Surface make_surface(std::vector<geometry::Triangle> triangles);

struct NearestTriangle {
    double distance = 0.0;  // m
    std::uint32_t triangle = 0;
};

// The nearest triangle within `reach` (m); an infinite distance if there is none.
NearestTriangle nearest(const geometry::Bvh& tree, const Vec3& point, double reach);

double point_triangle(const Vec3& point, const geometry::Triangle& triangle);  // m
// The distance of two triangles that do not cross (m). Triangles may be degenerate: a line or a point.
double triangle_triangle(const geometry::Triangle& a, const geometry::Triangle& b);

// How many times the surface encloses a point that is not on it: the crossings of a ray, counted with their
// direction.
int winding(const Surface& surface, const Vec3& point);
// The same by solid angles of all triangles. A. van Oosterom, J. Strackee: The solid angle of a plane
// triangle, IEEE Trans. Biomed. Eng. 30 (1983).
int winding_by_solid_angle(const geometry::Bvh& tree, const Vec3& point);

// m, negative inside; infinite if nothing is within `reach`.
double signed_distance(const Surface& surface, const Vec3& point, double reach = 1e9);

// Whether an edge of one surface passes through a triangle of the other.
bool cross(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a);

// The least distance of two surfaces that do not cross (m); `reach` if it is greater than that.
double gap(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a, double reach);

struct DepthOptions {
    double least = 5e-6;      // m: depths up to this are not resolved
    double enough = 1.0;      // m: the search stops at the first point that is deeper
    double tolerance = 1e-6;  // m
};

// For checks against 0.1 mm. Resolving what is hardly inside takes seconds where flat lies on flat.
inline constexpr DepthOptions from_50_um{.least = 50e-6, .enough = 1.0, .tolerance = 10e-6};

// The greatest depth of a point of surface `mine` in `other` (m). A depth up to `least` may be returned
// smaller than it is.
double depth_in(const geometry::Bvh& mine, const Surface& other, const Pose& mine_to_other,
                const DepthOptions& options);

// The greatest depth of a point of either surface in the other; 0 if they do not cross.
double depth(const Surface& a, const Surface& b, const Pose& b_to_a, const DepthOptions& options = {});

}  // namespace bolt::contact_oracle
