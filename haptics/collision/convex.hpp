// Convex solids with few faces, and where two of them meet: exact, for parts that fit into each other with a
// tenth of a millimetre to spare.
//
// Two convex solids are apart by s along n if one lies wholly on one side of a slab of that width. The
// greatest s over all n is the distance where they are apart and face meets corner or edge meets edge, less
// than the distance where corner meets corner, and minus the depth where they are in each other; it is found
// among the normals of both solids' faces and the cross products of those edges whose Gauss arcs cross
// (Gottschalk, Lin, Manocha, SIGGRAPH 1996; for the arcs: Gregorius, Game Developers Conference 2013).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "haptics/collision/contact.hpp"

namespace bolt::collision {

// Points x with normal · x ≤ offset.
struct HalfSpace {
    Vec3 normal{0.0, 0.0, 1.0};  // unit, outward
    double offset = 0.0;         // m
};

struct ConvexFace {
    HalfSpace plane;
    std::uint32_t begin = 0, end = 0;  // its corners in `loops`, counter-clockwise seen from outside
};

struct ConvexEdge {
    std::uint32_t from = 0, to = 0;     // points
    std::uint32_t left = 0, right = 0;  // faces
    std::uint32_t direction = 0;        // the same for edges that point the same way; edges are in its order
};

// A set of a solid's edges.
using EdgeSet = std::array<std::uint64_t, 2>;
inline constexpr std::size_t most_edges = 128;

struct Convex {
    std::vector<Vec3> points;
    std::vector<ConvexFace> faces;
    std::vector<ConvexEdge> edges;
    std::vector<std::uint32_t> loops;
    std::vector<EdgeSet> left_of, right_of;  // by face: the edges that have it on that side
    std::vector<Vec3> directions;            // that edges have
    std::vector<EdgeSet> in_direction;       // and which
    Vec3 middle{0.0};
    double radius = 0.0;  // m, about the middle
};

// What the half spaces leave, which must be bounded; those that cut nothing off are left out.
Convex make_convex(std::span<const HalfSpace> half_spaces);

// How far two solids are apart, and along what.
struct Separation {
    double distance = 0.0;  // m, the greatest; below 0 they are in each other
    Vec3 normal{0.0};       // unit, in the obstacle's frame, from the obstacle to the tool
    // The features that meet: one of the obstacle and one of the tool. Faces count from 0; of edges both are
    // given.
    enum class Kind : std::uint8_t { obstacle_face, tool_face, edges } kind = Kind::obstacle_face;
    std::uint32_t on_obstacle = 0, on_tool = 0;
};

// `to_obstacle`: the tool's frame to the obstacle's. Beyond `band` some lower bound that is > band.
Separation separation(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle, double band);

inline constexpr std::size_t most_meeting = 12;

// Where they meet, in the obstacle's frame: the corners of what two nearly parallel faces have in common, or
// a point. The normal of all is the separation's, no distance is less than its. Returns how many.
std::size_t meeting_points(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle,
                           const Separation& separation, std::span<Contact, most_meeting> out);

}  // namespace bolt::collision
