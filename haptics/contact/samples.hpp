// Where a surface is touched first, in clusters of neighbours so that most of it is done with at once.
//
// Two solids touch where one of them at least curves outward: at a corner, along an edge (there edge to edge,
// or with a round face), on a round face. Flat and hollow places need no points of their own, for what they
// touch has them.
#pragma once

#include <cstdint>
#include <vector>

#include "haptics/contact/solid.hpp"

namespace bolt::contact {

// A point, or a piece of a convex edge.
struct Sample {
    static constexpr std::uint32_t no_piece = 0xffffffffU;
    Vec3 at{0.0};                    // m; of an edge piece the middle
    std::uint32_t triangle = 0;      // one that it lies on
    std::uint32_t piece = no_piece;  // which
};

struct Piece {
    Vec3 half{0.0};                // m, from the middle to its end
    double half_length = 0.0;      // of `half`
    std::array<Vec3, 2> inward{};  // as SharpEdge has them
};

// A sphere about some samples, edge pieces with their ends.
struct Cluster {
    Vec3 middle{0.0};
    double radius = 0.0;
    double reach = 0.0;                // of its samples from the origin of the frame
    std::uint32_t begin = 0, end = 0;  // its samples, or the clusters of the level below that it holds
};

inline constexpr std::size_t cluster_size = 16;

struct Samples {
    std::vector<Sample> samples;  // cluster after cluster
    std::vector<Piece> pieces;
    // Of samples first, then of clusters, up to a level of few; in each those of one cluster follow each
    // other.
    std::vector<std::vector<Cluster>> levels;
};

struct SampleOptions {
    double longest_piece = 4e-3;  // m, of an edge; pieces that follow each other nearly straight become one
    // Of two solids one has pieces of its edges (and is asked with them about the other's), the other has
    // points along its round faces: where these meet each other, one side's are enough.
    bool edges = true, round = false;
    // m, between points along edges. A fillet of the other that crosses one between two of them is seen too
    // late: over half of 1.5 mm a fillet of 1 mm falls by 0.28 mm, over half of 1.1 mm by 0.15.
    double along_edges = 1.5e-3;
    std::size_t on_faces = 0;  // points spread evenly over everything, for round faces that curve too little
};

// Edges sharper than this get points along them: round faces touch them anywhere.
inline constexpr double keen_angle = 20.0 * pi / 180.0;

// The same for the same mesh.
Samples make_samples(const Solid& solid, const SampleOptions& options);

}  // namespace bolt::contact
