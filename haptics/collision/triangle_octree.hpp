// An octree over the surroundings of a solid, built at load and refined near curved surfaces. Each cell
// stores the signed distance of its centre; a leaf also lists the triangles within `listing_distance` of any
// point in it. A query returns distance bounds without visiting triangles; near the surface the listed
// triangles give exact distances.
#pragma once

#include <optional>

#include "haptics/collision/solid.hpp"

namespace bolt::collision {

inline constexpr double listing_distance = 0.7e-3;  // m; triangles this near to a leaf are listed in it
inline constexpr int octree_levels = 5;             // of subdivision below the root cells
inline constexpr std::size_t max_listed = 256;      // triangles of a leaf; a leaf with more lists none

struct OctreeLeaf {
    std::uint32_t begin = 0, end = 0;  // range in `TriangleOctree::triangles`
    // First index in `TriangleOctree::boxes` of the triangles' bounding boxes: the lowest x of every
    // triangle, then y, then z, then the highest x, y and z. Each coordinate is padded to a multiple of four
    // entries.
    std::uint32_t boxes = 0;
    // The plane of the points x with normal · x = height. All triangles are behind it; `spread` (rad) bounds
    // the angle between their normals and the plane's.
    Vec3 normal{0.0};
    double height = 0.0;
    float spread = 0.0F;
    bool front = false;  // the part of the cell in front of the plane is outside the solid
    // All triangles belong to one part, and none rises above another's plane (within listing_distance). A
    // point outside the part then has exactly one separating plane.
    bool convex = false;
};

struct OctreeNode {
    float distance;     // m, signed, at the centre
    std::int32_t next;  // > 0: index of the first of eight children; < 0: minus the leaf's index; 0: empty
};

struct TriangleOctree {
    Vec3 low{0.0};                                  // m, lowest corner of the first root cell
    double root_size = 0.0;                         // m, of a root cell
    double inverse_root_size = 0.0;                 // 1/m
    std::array<double, octree_levels + 1> sizes{};  // m, cell size by level
    double rounding = 0.0;                          // m; exceeds the error of points and distances in float
    std::array<int, 3> root_counts{};               // root cells along each axis; 0: the octree is empty
    std::vector<OctreeNode> nodes;                  // root cells first, x fastest
    std::vector<OctreeLeaf> leaves;                 // the first is not used: index 0 means empty
    std::vector<std::uint32_t> triangles;           // indices of the listed triangles, leaf by leaf
    std::vector<float> boxes;                       // m, bounding boxes of the listed triangles (OctreeLeaf)
};

// `cell`: m, size of the smallest cells; 0 gives an empty octree. The octree extends beyond the solid's box
// by one root cell.
TriangleOctree make_triangle_octree(const Solid& solid, double cell);

// Bounds at a point: lower ≤ signed distance and |signed distance| ≤ upper. Outside the octree the bounds are
// infinite.
struct OctreeQuery {
    double lower = -infinite_distance, upper = infinite_distance;  // m
    const OctreeLeaf* leaf = nullptr;                              // null: no triangles are listed
    // m; lower bound of the distance to any triangle that `leaf` does not list. Without a leaf it is valid
    // only if the cell has no triangles, not if it has more than max_listed.
    double unlisted_distance = 0.0;
};
OctreeQuery query(const TriangleOctree& octree, const Vec3& point);

// The leaf of the last query. Queries at nearby points reuse it instead of descending from the root.
struct OctreeCursor {
    Vec3 middle{0.0};    // m, from `TriangleOctree::low`
    double half = -1.0;  // m, half the cell's size; negative: no cell
    const OctreeNode* node = nullptr;
};
OctreeQuery query(const TriangleOctree& octree, const Vec3& point, OctreeCursor& last);

// The signed distance and the separating planes of query_point(), from the triangles that `found.leaf` lists.
// `found.leaf` must not be null. Empty if the nearest listed triangle is further than
// `found.unlisted_distance`. `band` must not exceed listing_distance.
std::optional<PointQueryResult> query_listed(const Solid& solid, const TriangleOctree& octree,
                                             const OctreeQuery& found, const Vec3& point, double band,
                                             std::span<SeparatingPlane> planes);

}  // namespace bolt::collision
