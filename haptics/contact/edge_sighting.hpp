// The edges near a piece are looked for seldom, and compared with as often as it is asked.
#pragma once

#include "haptics/contact/edges.hpp"

namespace bolt::contact {

// The edges that a piece can meet, as found when its middle was there and that turn was made.
struct EdgeSighting {
    glm::vec3 at{0.0F};
    double turned = 0.0;  // rad, in all by then
    double radius = 0.0;  // m, within which they are; 0: nothing is known
    FacingEdges facing;
};

// Of a piece that had an edge within this (m) when it was asked last edges are looked for as far beyond what
// is needed, of others further: they may not be asked again for long.
inline constexpr double short_lookahead = 2e-3;

// As near_edges. `turned` (rad): the piece's turns in all until now; `looked`: edges had to be looked for.
Crossings meet_edges(const Solid& solid, const EdgePiece& piece, const Solid& other, const Pose& to_other,
                     double turned, double band, bool near_before, EdgeSighting& edges, bool& looked,
                     std::span<Crossing> crossings);

}  // namespace bolt::contact
