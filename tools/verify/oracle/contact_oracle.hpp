// Exact distance, penetration depth and winding number of closed surfaces: the reference for contact queries
// and the god-object. It uses all triangles in double precision, without normals or samples, and nothing of
// haptics/collision. A bounding-volume tree skips only triangles that cannot change the result;
// tests/contact_validation/surface.cpp compares it with plain loops over all triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/math.hpp"
#include "tools/author/geometry/bvh.hpp"

namespace bolt::contact_oracle {

// A closed surface in its own frame (m). Triangles are anticlockwise seen from outside. It may consist of
// several closed surfaces that overlap.
struct ClosedSurface {
    geometry::Bvh tree;
};

ClosedSurface make_surface(std::vector<geometry::Triangle> triangles);

struct NearestTriangle {
    double distance = 0.0;  // m
    std::uint32_t triangle = 0;
};

// Returns the nearest triangle within `reach` (m); an infinite distance if there is none.
NearestTriangle nearest(const geometry::Bvh& tree, const Vec3& point, double reach);

double point_triangle(const Vec3& point, const geometry::Triangle& triangle);  // m
// Returns the distance of two triangles that do not cross (m). A triangle may be degenerate: a line or a
// point.
double triangle_triangle(const geometry::Triangle& a, const geometry::Triangle& b);

// Returns the winding number of the surface about a point that is not on it, from the signed crossings of a
// ray.
int winding(const ClosedSurface& surface, const Vec3& point);
// Returns the same number from the solid angles of all triangles. A. van Oosterom, J. Strackee: The solid
// angle of a plane triangle, IEEE Trans. Biomed. Eng. 30 (1983).
int winding_by_solid_angle(const geometry::Bvh& tree, const Vec3& point);

// Returns the signed distance (m), negative inside; infinite if the surface is further than `reach`.
double signed_distance(const ClosedSurface& surface, const Vec3& point, double reach = 1e9);

// Returns whether an edge of one surface passes through a triangle of the other.
bool cross(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a);

// Returns the distance of two surfaces that do not cross (m), or `reach` if that is smaller.
double gap(const geometry::Bvh& a, const geometry::Bvh& b, const Pose& b_to_a, double reach);

struct DepthOptions {
    double min_depth = 5e-6;  // m: smaller depths are not resolved
    double stop_depth = 1.0;  // m: the search stops at the first point at least this deep
    double tolerance = 1e-6;  // m
};

// For checks against 0.1 mm. Where flat faces touch, resolving smaller depths takes seconds.
inline constexpr DepthOptions from_50_um{.min_depth = 50e-6, .stop_depth = 1.0, .tolerance = 10e-6};

// Returns the greatest depth of a point of surface `mine` in `other` (m). For depths up to `min_depth` the
// result may be too small.
double depth_in(const geometry::Bvh& mine, const ClosedSurface& other, const Pose& mine_to_other,
                const DepthOptions& options);

// Returns the greatest depth of a point of either surface in the other (m); 0 if they do not cross.
double depth(const ClosedSurface& a, const ClosedSurface& b, const Pose& b_to_a,
             const DepthOptions& options = {});

}  // namespace bolt::contact_oracle
