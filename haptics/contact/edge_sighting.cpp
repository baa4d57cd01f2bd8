#include "haptics/contact/edge_sighting.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

constexpr double edge_lookahead = 3e-3;
// What has to be left (m, rad) of what is known of edges for it to be used again.
constexpr double worth_asking = 0.1e-3, worth_asking_turn = 2e-3;
// More than the rounding of positions and distances in float.
constexpr double rounding_in_float = 1e-6;

}  // namespace

Crossings meet_edges(const Solid& solid, const EdgePiece& piece, const Solid& other, const Pose& to_other,
                     double turned, double band, bool near_before, EdgeSighting& edges, bool& looked,
                     std::span<Crossing> crossings) {
    const double by = turned - edges.turned;
    const double way =
        glm::length(piece.middle - Vec3(edges.at)) + glm::length(piece.half) * by + rounding_in_float;
    const double deepest = std::max(band, deepest_crossing);
    looked = !(edges.facing.all && edges.radius - way > deepest + band + worth_asking &&
               edges.facing.turn - by > worth_asking_turn);
    if (!looked) {
        FacingEdges facing = edges.facing;
        facing.turn -= by;
        return near_facing_edges(solid, piece, other, to_other, edges.radius - way, band, crossings, facing);
    }
    edges.at = glm::vec3(piece.middle);
    edges.turned = turned;
    edges.radius = deepest + (near_before ? short_lookahead : edge_lookahead);
    return near_edges(solid, piece, other, to_other, edges.radius, band, crossings, edges.facing);
}

}  // namespace bolt::contact
