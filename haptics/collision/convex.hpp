// Convex solids with few faces, their separation and their contact points. Exact, for parts that fit into
// each other with a clearance of a tenth of a millimetre.
//
// Two convex solids are separated by s along n if a slab of width s, normal to n, lies between them. The
// greatest s over all n equals the distance if the nearest features are face and corner or two edges. It is
// less than the distance if the nearest features are two corners, or a corner and an edge. It is minus the
// penetration depth if the solids overlap. The n of the greatest s is a normal of a face, or the cross
// product of two edges whose arcs on the Gauss map cross, so only these directions are tried (Gottschalk,
// Lin, Manocha, SIGGRAPH 1996; for the arcs: Gregorius, Game Developers Conference 2013).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/collision/contact.hpp"

namespace bolt::collision {

// Points x with normal · x ≤ offset.
struct HalfSpace {
    Vec3 normal{0.0, 0.0, 1.0};  // unit, outward
    double offset = 0.0;         // m
};

struct ConvexFace {
    HalfSpace plane;
    std::uint32_t begin = 0, end = 0;  // range of its corners in `loops`, counter-clockwise seen from outside
};

struct ConvexEdge {
    std::uint32_t from = 0, to = 0;     // indices of points
    std::uint32_t left = 0, right = 0;  // indices of the faces on either side, seen from outside
    // Index in `directions`; parallel edges share it, and edges are sorted by it.
    std::uint32_t direction = 0;
};

// A set of a solid's edges, one bit each.
using EdgeSet = std::array<std::uint64_t, 2>;
inline constexpr std::size_t max_edges = 128;
inline constexpr std::size_t max_convex_points = 64;  // of a solid; also the limit of its faces

struct Convex {
    std::vector<Vec3> points;
    std::vector<ConvexFace> faces;
    std::vector<ConvexEdge> edges;
    std::vector<std::uint32_t> loops;        // indices of points: the corners of each face in turn
    std::vector<EdgeSet> left_of, right_of;  // by face: the edges that have it on their left or right side
    std::vector<Vec3> directions;            // unit, distinct directions of edges
    std::vector<EdgeSet> in_direction;       // by direction: the edges that have it
    Vec3 middle{0.0};                        // m, mean of the points
    double radius = 0.0;                     // m, of the bounding sphere about `middle`
};

// The intersection of the half spaces, which must be bounded. Half spaces that cut nothing off give no face.
// Fails if the solid has more points, faces or edges than the limits above.
Result<Convex> make_convex(std::span<const HalfSpace> half_spaces);

enum class FeaturePair : std::uint8_t { obstacle_face, tool_face, edges };

// The separation of two solids and the features that determine it.
struct Separation {
    double distance = 0.0;  // m, greatest over all directions; negative: the solids overlap
    Vec3 normal{0.0};       // unit, in the obstacle's frame, from the obstacle to the tool
    // The features that determine the separation, as indices of faces or edges; for a face only its own index
    // is set.
    FeaturePair features = FeaturePair::obstacle_face;
    std::uint32_t on_obstacle = 0, on_tool = 0;
};

// `to_obstacle`: the tool's frame to the obstacle's. If the separation exceeds `band` (m), the returned
// distance is a lower bound of it that also exceeds `band`.
Separation separation(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle, double band);

inline constexpr std::size_t max_contact_points = 12;

// Writes the contact points in the obstacle's frame: the corners of the overlap of two nearly parallel faces,
// or one point. All have the separation's normal, and no distance is less than the separation's. Returns
// their number.
std::size_t contact_points(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle,
                           const Separation& separation, std::span<Contact, max_contact_points> out);

}  // namespace bolt::collision
