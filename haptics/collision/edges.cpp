#include "haptics/collision/edges.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "haptics/collision/closest.hpp"

namespace bolt::collision {
namespace {

// m, added to the search radius of a piece that had no edge within short_lookahead at its last query.
constexpr double edge_lookahead = 3e-3;
// m and rad. A new search starts unless the cached search radius, less the motion since that search, exceeds
// the necessary radius by min_cached_distance, and the remaining turn exceeds min_cached_turn.
constexpr double min_cached_distance = 0.1e-3, min_cached_turn = 2e-3;

bool nearer_crossing(const Crossing& a, const Crossing& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.edge < b.edge;
}

struct EdgeGathering {
    const Solid* solid;
    const EdgePiece* piece;
    double half_length;  // m, of the piece
    glm::vec3 along;     // unit
    std::array<glm::vec3, 2> inward;
    glm::vec3 low, high;  // m, bounding box of the piece
    float radius_float;   // m, the radius with a margin
    double radius, band;
    std::array<Crossing, 16> found;
    std::size_t count = 0;
    double clear_distance, clear_turn = infinite_distance;
    FacingEdges* facing = nullptr;
    double nearest_dropped = infinite_distance;

    void add(Crossing crossing) {
        if (count < found.size()) {
            found[count++] = crossing;
            return;
        }
        const auto last = std::max_element(found.begin(), found.end(), nearer_crossing);
        if (nearer_crossing(crossing, *last)) std::swap(crossing, *last);
        nearest_dropped = std::min(nearest_dropped, crossing.distance);
    }
};

// Largest cosine between an inward direction of an edge and the common perpendicular away from that edge's
// solid: `normal` for `edge`, −`normal` for `piece`. At most 0: the perpendicular points out of both solids,
// so the edges face each other. Above 0: a face, a vertex or another edge is nearer. The sense of `normal` is
// arbitrary, so the smaller of the cosines for `normal` and −`normal` is returned.
double facing_excess(const Ridge& edge, const EdgePiece& piece, const Vec3& normal) {
    double with = -1.0, against = -1.0;
    for (std::size_t i = 0; i < 2; ++i) {
        const double of_edge = glm::dot(normal, Vec3(edge.inward[i]));
        const double of_piece = glm::dot(normal, piece.inward[i]);
        with = std::max({with, of_edge, -of_piece});
        against = std::max({against, -of_edge, of_piece});
    }
    constexpr double slack = 1e-6;
    return std::min(with - slack, against - slack);
}

// rad; if the piece must turn by more than this before the edge can face it, the distance is not computed.
constexpr double useful_turn = 0.02;

// Returns true if the bounding boxes prove that the edge is further than the radius from the piece.
bool is_out_of_radius(const EdgeGathering& g, const Ridge& edge) {
    const glm::vec3 low = glm::min(edge.ends[0], edge.ends[1]);
    const glm::vec3 high = glm::max(edge.ends[0], edge.ends[1]);
    const glm::vec3 gap = glm::max(glm::max(low - g.high, g.low - high), glm::vec3(0.0F));
    return glm::dot(gap, gap) > g.radius_float * g.radius_float;
}

// Returns true if the piece must turn by more than useful_turn before the common perpendicular points out of
// both solids. This rejects most edges.
bool needs_large_turn(EdgeGathering& g, const Ridge& edge) {
    constexpr float rounding_of_turns = 1e-3F;
    const glm::vec3 across = glm::cross(g.along, edge.along);
    float plus = -1.0F, minus = -1.0F;
    for (std::size_t i = 0; i < 2; ++i) {
        const float of_edge = glm::dot(across, edge.inward[i]), of_piece = glm::dot(across, g.inward[i]);
        plus = std::max({plus, of_edge, -of_piece});
        minus = std::max({minus, -of_edge, of_piece});
    }
    const double turn = static_cast<double>(std::min(plus, minus) / 3.0F - rounding_of_turns);
    if (turn > useful_turn) g.facing->turn = std::min(g.facing->turn, turn);
    return turn > useful_turn;
}

// An edge and the piece, and where they are closest.
struct EdgePair {
    const Ridge& edge;
    Vec3 middle, half;   // of the edge
    Vec3 across;         // the half of the piece × that of the edge
    double size;         // of `across`
    double half_length;  // m, of `half`
    double sine;         // of the angle between them
    ClosestSegmentParameters at;
};

EdgePair edge_pair(const EdgeGathering& g, const Ridge& edge) {
    const Vec3 a(edge.ends[0]), b(edge.ends[1]);
    EdgePair pair{edge, 0.5 * (a + b), 0.5 * (b - a), {}, 0.0, 0.0, 0.0, {}};
    pair.across = glm::cross(g.piece->half, pair.half);
    pair.size = glm::length(pair.across);
    pair.half_length = glm::length(pair.half);
    pair.sine = pair.size / (g.half_length * pair.half_length);
    return pair;
}

// Returns true if the edges do not face each other, and lowers `g.clear_turn` to the turn (rad) of the piece
// before which they cannot: a turn φ of the piece, below `sine`/3, turns the common perpendicular by at most
// 1.5 φ/`sine`. Otherwise sets `pair.at`.
bool faces_away(EdgeGathering& g, EdgePair& pair, const Vec3& normal) {
    const double excess = facing_excess(pair.edge, *g.piece, normal);
    const double turn = excess * pair.sine / 3.0;
    if (turn >= g.clear_turn) return true;
    if (turn > useful_turn) {
        g.clear_turn = turn;
        return true;
    }
    pair.at = closest_on_segments(g.piece->middle, g.piece->half, pair.middle, pair.half);
    if (excess <= 0.0) return false;
    const Vec3 between = g.piece->middle + pair.at.s * g.piece->half - pair.middle - pair.at.t * pair.half;
    if (glm::dot(between, between) <= g.radius * g.radius) g.clear_turn = turn;
    return true;
}

// The feet of the common perpendicular lie beyond the ends of the segments. Bounds the motion up to which the
// edges cannot cross. `apart`: m, the distance of the segments. `beyond`: m by which `apart` exceeds
// max_crossing_depth, less a margin.
void bound_feet(EdgeGathering& g, const EdgePair& pair, const Vec3& normal, double apart, double beyond) {
    const Vec3 between = pair.middle - g.piece->middle;
    const double on_piece = glm::dot(glm::cross(between, pair.half), pair.across) / (pair.size * pair.size);
    const double on_edge =
        glm::dot(glm::cross(between, g.piece->half), pair.across) / (pair.size * pair.size);
    // m by which the feet lie beyond the ends. A displacement d moves the feet by at most 1.12 d/sine, a turn
    // φ by at most 4.8 `apart` φ/sine.
    const double over =
        std::max((std::abs(on_piece) - 1.0) * g.half_length, (std::abs(on_edge) - 1.0) * pair.half_length);
    double clear = std::min(apart, 0.4 * over * pair.sine);
    double turn = std::min(0.05 * pair.sine, over * pair.sine * pair.sine / (10.0 * apart));
    // The lines are apart and must touch before they can pass each other. Their distance decreases at most by
    // the displacement plus the turn times the distance of the foot.
    const double distance = -glm::dot(between, normal);
    if (const double until = std::min(apart, 0.8 * distance); until > clear) {
        clear = until;
        turn = std::min(0.05 * pair.sine, 0.15 * distance / (std::abs(on_piece) * g.half_length + 1e-9));
    }
    if (clear > beyond) {
        g.clear_distance = std::min(g.clear_distance, clear);
        g.clear_turn = std::min(g.clear_turn, turn);
    } else {
        g.clear_distance = std::min(g.clear_distance, beyond);
    }
}

// Compares one edge with the piece: adds their crossing, or bounds the motion until there may be one.
void add_edge_pair(EdgeGathering& g, std::uint32_t index) {
    EdgePair pair = edge_pair(g, g.solid->ridges[index]);
    const bool parallel = !(pair.sine > 1e-3);
    Vec3 normal(0.0);
    if (parallel) {
        pair.at = closest_on_segments(g.piece->middle, g.piece->half, pair.middle, pair.half);
    } else {
        normal = pair.across / pair.size;
        if (faces_away(g, pair, normal)) return;
    }
    const Vec3 on_piece = g.piece->middle + pair.at.s * g.piece->half;
    const Vec3 on_edge = pair.middle + pair.at.t * pair.half;
    const double apart = glm::length(on_piece - on_edge);
    if (apart > g.radius) return;
    // Nearly parallel edges are compared at their middles only; the error is at most their angle times the
    // length.
    const double beyond = apart - max_crossing_depth - (pair.at.inner ? 0.0 : 2e-3 * g.half_length);
    if (parallel) {
        g.clear_distance = std::min(g.clear_distance, beyond);
        return;
    }
    if (glm::dot(normal, Vec3(pair.edge.normals[0]) + Vec3(pair.edge.normals[1])) < 0.0) normal = -normal;
    if (!pair.at.inner) {
        bound_feet(g, pair, normal, apart, beyond);
        return;
    }
    const Crossing crossing{glm::dot(on_piece - on_edge, normal), on_piece, on_edge, normal,
                            pair.edge.sharp_edge};
    if (crossing.distance > 0.0) {
        // The edges can change sides only by passing through each other.
        g.clear_distance = std::min(g.clear_distance, 0.9 * crossing.distance);
        g.clear_turn = std::min(g.clear_turn, 0.1 * pair.sine);
    } else {
        g.clear_distance = std::min(g.clear_distance, beyond);
    }
    if (crossing.distance > g.band || crossing.distance < -max_crossing_depth) return;
    g.add(crossing);
}

bool gather_edge(RTCPointQueryFunctionArguments* arguments) {
    auto& g = *static_cast<EdgeGathering*>(arguments->userPtr);
    const Ridge& edge = g.solid->ridges[arguments->primID];
    if (is_out_of_radius(g, edge) || needs_large_turn(g, edge)) return false;
    FacingEdges& facing = *g.facing;
    facing.all = facing.all && facing.count < facing.ridges.size();
    if (facing.all) facing.ridges[facing.count++] = arguments->primID;
    add_edge_pair(g, arguments->primID);
    return false;
}

bool is_inside(const Solid& solid, const Vec3& point) {
    return query_point(solid, point, infinite_distance, 0.0, {}).distance < 0.0;
}

EdgeGathering make_gathering(const Solid& solid, const EdgePiece& piece, double radius, double band) {
    EdgeGathering g;
    g.solid = &solid;
    g.piece = &piece;
    g.half_length = glm::length(piece.half);
    g.radius = std::max({radius, band, max_crossing_depth});
    g.clear_distance = g.radius - max_crossing_depth;
    g.band = band;
    return g;
}

EdgeQueryResult select_crossings(EdgeGathering& g, const Solid& other, const Pose& to_other,
                                 std::span<Crossing> crossings) {
    std::sort(g.found.begin(), g.found.begin() + static_cast<std::ptrdiff_t>(g.count), nearer_crossing);
    EdgeQueryResult result{0, std::min(g.band, g.nearest_dropped), g.clear_distance, g.clear_turn};
    for (const Crossing& c : std::span(g.found).first(g.count)) {
        if (c.distance < -ambiguous_depth && !is_inside(*g.solid, c.on_piece) &&
            (c.distance < -g.band || !is_inside(other, to_other * c.on_edge)))
            continue;
        if (result.count == crossings.size()) {
            result.complete_within = std::min(result.complete_within, c.distance);
            break;
        }
        crossings[result.count++] = c;
    }
    return result;
}

}  // namespace

EdgeQueryResult query_edges(const Solid& solid, const EdgePiece& piece, const Solid& other,
                            const Pose& to_other, double radius, double band, std::span<Crossing> crossings,
                            FacingEdges& facing) {
    facing.count = 0;
    facing.all = true;
    facing.turn = infinite_distance;
    if (!solid.edge_scene) return {0, band, infinite_distance, infinite_distance};
    EdgeGathering g = make_gathering(solid, piece, radius, band);
    g.facing = &facing;
    g.along = glm::vec3(piece.half / g.half_length);
    for (std::size_t i = 0; i < 2; ++i) g.inward[i] = glm::vec3(piece.inward[i]);
    const glm::vec3 middle(piece.middle);
    const glm::vec3 extent = glm::abs(glm::vec3(piece.half));
    g.low = middle - extent;
    g.high = middle + extent;
    g.radius_float = with_margin(g.radius, piece.middle);
    RTCPointQuery query = make_query(piece.middle, g.half_length + g.radius);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(solid.edge_scene.get(), &query, &context, gather_edge, &g);
    g.clear_turn = std::min(g.clear_turn, facing.turn);
    return select_crossings(g, other, to_other, crossings);
}

namespace {

// As `query_edges`, among the candidates of an earlier query. `radius` and `turn` (FacingEdges::turn) must be
// reduced by the piece's motion since then, and `facing.all` must be true.
EdgeQueryResult query_facing_edges(const Solid& solid, const EdgePiece& piece, const Solid& other,
                                   const Pose& to_other, double radius, double turn, double band,
                                   std::span<Crossing> crossings, const FacingEdges& facing) {
    EdgeGathering g = make_gathering(solid, piece, radius, band);
    g.clear_turn = turn;
    for (std::uint32_t i = 0; i < facing.count; ++i) add_edge_pair(g, facing.ridges[i]);
    return select_crossings(g, other, to_other, crossings);
}

}  // namespace

EdgeQueryResult query_edges_cached(const Solid& solid, const EdgePiece& piece, const Solid& other,
                                   const Pose& to_other, double turned, double band, bool near_before,
                                   EdgeCache& cache, bool& searched, std::span<Crossing> crossings) {
    const double turn = turned - cache.turned;
    const double displacement =
        glm::length(piece.middle - Vec3(cache.at)) + glm::length(piece.half) * turn + rounding_in_float;
    const double deepest = std::max(band, max_crossing_depth);
    searched = !(cache.facing.all && cache.radius - displacement > deepest + band + min_cached_distance &&
                 cache.facing.turn - turn > min_cached_turn);
    if (!searched) {
        return query_facing_edges(solid, piece, other, to_other, cache.radius - displacement,
                                  cache.facing.turn - turn, band, crossings, cache.facing);
    }
    cache.at = glm::vec3(piece.middle);
    cache.turned = turned;
    cache.radius = deepest + (near_before ? short_lookahead : edge_lookahead);
    return query_edges(solid, piece, other, to_other, cache.radius, band, crossings, cache.facing);
}

}  // namespace bolt::collision
