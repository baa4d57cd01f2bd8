// Where a surface is touched first: points on its corners, pieces of its convex edges, points spread evenly
// over its faces; in clusters of neighbours, so that most of them are done with at once.
#pragma once

#include <cstdint>
#include <vector>

#include "haptics/contact/solid.hpp"

namespace bolt::contact {

struct Sample {
    Vec3 at{0.0};                  // m; of an edge piece the middle
    Vec3 half{0.0};                // m; of an edge piece from `at` to its end, else 0
    double half_length = 0.0;      // of `half`
    std::uint32_t triangle = 0;    // one that it lies on
    std::array<Vec3, 2> inward{};  // of an edge piece, as SharpEdge has them
};

// A sphere about some samples, edge pieces with their ends.
struct Cluster {
    Vec3 middle{0.0};
    double radius = 0.0;
    double reach = 0.0;                // of its samples from the origin of the frame
    std::uint32_t begin = 0, end = 0;  // its samples; of a group: its clusters
};

inline constexpr std::size_t cluster_size = 16;

struct Samples {
    std::vector<Sample> samples;    // cluster after cluster
    std::vector<Cluster> clusters;  // group after group, each with the samples that follow
    std::vector<Cluster> groups;    // of clusters
};

// Corners, and edges in pieces no longer than `longest_piece` (pieces that follow each other nearly straight
// become one). Then as many points on faces as there is room for up to `count`, evenly spread, the same for
// the same mesh.
Samples make_samples(const Solid& solid, double longest_piece, std::size_t count);

}  // namespace bolt::contact
