// Points and edge pieces of a solid that can be the first to touch another solid, in a hierarchy of clusters.
//
// Two solids touch where at least one of them curves outward: at a corner, along an edge (against an edge or
// a round face), or on a round face. Flat and concave regions need no samples, because the other solid, which
// curves outward there, has samples at the contact.
#pragma once

#include <cstdint>
#include <vector>

#include "haptics/collision/solid.hpp"

namespace bolt::collision {

// A point, or a piece of a convex edge.
struct SurfaceSample {
    static constexpr std::uint32_t no_piece = 0xffffffffU;
    Vec3 at{0.0};                    // m; the middle of an edge piece
    std::uint32_t triangle = 0;      // a triangle that the sample lies on
    std::uint32_t piece = no_piece;  // index in `SurfaceSamples::pieces`; no_piece: a point
};

// The extent of an edge piece about its sample.
struct PieceExtent {
    Vec3 half{0.0};                // m, from the middle to the end
    double half_length = 0.0;      // m
    std::array<Vec3, 2> inward{};  // unit, in each of the two faces and away from the edge
};

// A bounding sphere of samples, including the ends of edge pieces.
struct SampleCluster {
    Vec3 middle{0.0};            // m
    double radius = 0.0;         // m
    double origin_radius = 0.0;  // m, greatest distance of its samples from the frame's origin
    // Range of samples on level 0; on other levels range of clusters of the level below.
    std::uint32_t begin = 0, end = 0;
};

inline constexpr std::size_t cluster_size = 16;  // children of a cluster at most

struct SurfaceSamples {
    std::vector<SurfaceSample> samples;  // those of a cluster are consecutive
    std::vector<PieceExtent> pieces;
    // Level 0 holds samples; the last level has at most cluster_size clusters.
    std::vector<std::vector<SampleCluster>> levels;
};

struct SampleOptions {
    double max_piece = 4e-3;  // m; edges that continue nearly straight are joined up to this length
    // `edges`: pieces of sharp edges, for a tool. `round`: points along round edges, for obstacles. Where a
    // sharp edge meets a round one, the samples of one of the two suffice.
    bool edges = true, round = false;
    // m, spacing of points along edges. A fillet of the other solid that crosses an edge between two points
    // is detected late: a fillet of radius 1 mm falls by 0.34 mm over half of 1.5 mm, by 0.16 mm over half
    // of 1.1 mm.
    double along_edges = 1.5e-3;
    std::size_t on_faces = 0;  // points spread evenly over the surface, for faces of very low curvature
};

// Deterministic: the same mesh gives the same samples in the same order.
SurfaceSamples make_samples(const Solid& solid, const SampleOptions& options);

}  // namespace bolt::collision
