// Contacts between edges: a straight piece of one solid's convex edge against the convex edges of another
// solid.
#pragma once

#include "haptics/collision/solid.hpp"

namespace bolt::collision {

// A straight piece of a convex edge, in the frame of the solid that it is compared with.
struct EdgePiece {
    Vec3 middle{0.0}, half{0.0};   // m; the piece extends from middle − half to middle + half
    std::array<Vec3, 2> inward{};  // unit, in each of the two faces and away from the edge
};

// The feet of the common perpendicular of a piece and an edge that face each other. Without initial values,
// because each query of an edge has room for many and uses few.
struct Crossing {
    double distance;         // m, signed; negative: the edges have passed through each other
    Vec3 on_piece, on_edge;  // m
    Vec3 normal;             // unit, away from the solid
    std::uint32_t edge;      // index in the solid's mesh.sharp_edges
};

// m; crossings deeper than this are not reported. Samples along the edges detect deeper penetration.
inline constexpr double max_crossing_depth = 2e-3;
// m; a deeper crossing is reported only if one of its points is inside the other solid. Otherwise the edges
// lie on both sides of a thin rib and do not touch.
inline constexpr double ambiguous_depth = 0.1e-3;
// m; exceeds the rounding error of positions and distances in float.
inline constexpr double rounding_in_float = 1e-6;

struct EdgeQueryResult {
    std::size_t count = 0;         // crossings written
    double complete_within = 0.0;  // m; all nearer crossings were written
    // As long as the piece's points move by less than (clear_distance − band), m, and it turns by less than
    // clear_turn, rad, no further crossing enters the band.
    double clear_distance = 0.0, clear_turn = 0.0;
};

// Two edges face each other if their common perpendicular points out of both solids; otherwise a face, a
// vertex or another edge is nearer. FacingEdges lists the candidate edges of a solid for a piece. An edge
// that is not listed is further away than the radius of the query, or cannot face the piece until the piece
// has turned by `turn` (rad).
struct FacingEdges {
    std::array<std::uint32_t, 40> ridges{};  // indices in `Solid::ridges`
    std::uint32_t count = 0;
    bool all = false;  // all candidates fitted into `ridges`
    double turn = 0.0;
};

// Finds the crossings, within `band`, of the piece with those edges of `solid` that face the piece. If the
// output is too small, the nearest crossings are written. `other` is the solid that the piece belongs to;
// `to_other` maps the frame of `solid` to that of `other`. Edges further away than `radius` are ignored.
// Fills `facing`.
EdgeQueryResult query_edges(const Solid& solid, const EdgePiece& piece, const Solid& other,
                            const Pose& to_other, double radius, double band, std::span<Crossing> crossings,
                            FacingEdges& facing);

// The candidates of a piece's last search, with its middle and accumulated turn at that time.
struct EdgeCache {
    glm::vec3 at{0.0F};   // m
    double turned = 0.0;  // rad
    double radius = 0.0;  // m, of the search; 0: no search yet
    FacingEdges facing;
};

// m. If an edge was within this distance of a piece at its last query, this distance is added to the radius
// of the next search, so that its candidates stay valid longer.
inline constexpr double short_lookahead = 2e-3;

// Returns the result of query_edges(), from the cached candidates while they are valid. `turned`: rad, the
// piece's accumulated turn. `near_before`: an edge was within `short_lookahead` at the last query. Sets
// `searched`: true if the candidates were no longer valid, so that the edges were searched again.
EdgeQueryResult query_edges_cached(const Solid& solid, const EdgePiece& piece, const Solid& other,
                                   const Pose& to_other, double turned, double band, bool near_before,
                                   EdgeCache& cache, bool& searched, std::span<Crossing> crossings);

}  // namespace bolt::collision
