#include "haptics/collision/narrow_phase.hpp"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

namespace bolt::collision {
namespace {

// m; a bound is computed this far beyond the present need, so that it lasts some ticks. Longer lookaheads
// make the queries more expensive.
constexpr double cluster_lookahead = 6e-3;
constexpr double sample_lookahead = 2.5e-3;
// Up to this many samples of a cluster without a valid bound are queried individually; for more, the
// cluster's bound is computed first.
constexpr std::size_t individual_queries = 4;
// Cost of an edge search, in queries of a sample.
constexpr std::uint32_t edge_search_cost = 10;
// m; exceeds the rounding error of poses and distances.
constexpr double rounding = 1e-9;
constexpr double no_bound = -1e9;

// rad; a leaf whose normals spread further gives no usable bound of the normal.
constexpr float max_normal_spread = 1.2F;

void reset(SurfaceQueryCache& cache, const SurfaceSamples& samples) {
    constexpr DistanceBound no_distance{no_bound, infinite_distance};
    cache.levels.resize(samples.levels.size());
    for (std::size_t i = 0; i < samples.levels.size(); ++i)
        cache.levels[i].assign(samples.levels[i].size(), no_distance);
    constexpr CachedQuery no_query{glm::vec3(0.0F), static_cast<float>(no_bound), 0.0, false};
    cache.level_queries.resize(samples.levels.size());
    for (std::size_t i = 0; i < samples.levels.size(); ++i)
        cache.level_queries[i].assign(samples.levels[i].size(), no_query);
    cache.samples.assign(samples.samples.size(), no_distance);
    cache.sample_queries.assign(samples.samples.size(), no_query);
    cache.edges.assign(samples.pieces.size(), {});
}

// Accumulates the relative motion: any point at r from the tool's origin has moved by at most moved + turned
// × |r|.
void accumulate_motion(PairCache& pair, const Pose& pose) {
    if (pair.empty) {
        pair.empty = false;
    } else {
        const Quat turn = glm::conjugate(pair.last.orientation) * pose.orientation;
        const double angle = 2.0 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
        pair.moved += glm::length(pose.position - pair.last.position) + rounding;
        pair.turned += angle;
    }
    pair.last = pose;
}

// A pose as matrix columns, which transforms points faster than a quaternion.
struct PoseMatrix {
    Vec3 x, y, z, origin;

    explicit PoseMatrix(const Pose& pose)
        : x(pose.orientation * Vec3(1, 0, 0)),
          y(pose.orientation * Vec3(0, 1, 0)),
          z(pose.orientation * Vec3(0, 0, 1)),
          origin(pose.position) {}
    [[nodiscard]] Vec3 turned(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
    Vec3 operator*(const Vec3& p) const { return turned(p) + origin; }
};

// Queries the samples of one solid against the surface of the other.
class SurfaceQueryPass {
  public:
    SurfaceQueryPass(const CollisionWorld& world, const Body& body, std::uint32_t body_index,
                     const Solid& tool, const SurfaceSamples& samples, const Solid& surface,
                     const TriangleOctree& octree, const Pose& to_surface, const Pose& to_assembly,
                     bool of_tool, double band, ContactCollector& collected)
        : world_(world),
          body_(body),
          body_index_(body_index),
          tool_(tool),
          samples_(samples),
          surface_(surface),
          octree_(octree),
          from_surface_(inverse(to_surface)),
          to_surface_(to_surface),
          to_assembly_(to_assembly),
          of_tool_(of_tool),
          band_(band),
          collected_(collected) {}

    // `origin_radius`: m, of the tool. Seen from an obstacle's samples the tool moves, so the motion of the
    // tool's outermost point bounds the change of their distances.
    void run(SurfaceQueryCache& cache, const PairCache& pair, double origin_radius) const {
        const AccumulatedMotion motion{pair.moved, pair.turned, origin_radius};
        const std::size_t top = samples_.levels.size() - 1;
        for (std::uint32_t i = 0; i < samples_.levels[top].size(); ++i) visit(cache, motion, top, i);
    }

    // Computes the contact of a deferred sample; false if there is none within the band.
    bool resolve(const DeferredContact& one, SurfaceQueryCache& cache, Contact& contact) const {
        const Vec3 at = to_surface_ * samples_.samples[one.sample].at;
        const OctreeQuery octree_query = query(octree_, at);
        std::array<SeparatingPlane, 1> plane;
        const auto near = query_listed(surface_, octree_, octree_query, at, band_, plane);
        if (!near) return false;
        store_bound(cache, one.sample, at, near->distance, one.accumulated);
        if (near->planes == 0) return false;
        contact = contact_of(one.sample, at, plane[0]);
        return true;
    }

  private:
    struct AccumulatedMotion {
        double moved, turned, origin_radius;
    };
    // The accumulated motion of the samples of one cluster.
    struct SampleMotion {
        double displacement;  // m; no sample has moved further
        double turn;          // rad
    };
    [[nodiscard]] SampleMotion motion_of(const SampleCluster& cluster,
                                         const AccumulatedMotion& motion) const {
        return {motion.moved + motion.turned * (of_tool_ ? cluster.origin_radius : motion.origin_radius),
                motion.turned};
    }

    void visit(SurfaceQueryCache& cache, const AccumulatedMotion& motion, std::size_t level,
               std::uint32_t i) const {
        const SampleCluster& cluster = samples_.levels[level][i];
        DistanceBound& bound = cache.levels[level][i];
        const SampleMotion accumulated = motion_of(cluster, motion);
        if (holds(bound, accumulated)) return;
        const Vec3 middle = to_surface_ * cluster.middle;
        CachedQuery& last = cache.level_queries[level][i];
        bound.lower = std::max(
            bound.lower, updated_bound(last, middle, cluster.radius, accumulated) + accumulated.displacement);
        if (holds(bound, accumulated)) return;
        const bool near_before =
            last.lower > 0.5F * static_cast<float>(no_bound) && static_cast<double>(last.lower) <= band_;
        bound = level == 0 ? query_cluster(cache, cluster, middle, bound.lower - accumulated.displacement,
                                           near_before, accumulated)
                           : query_children(cache, motion, level, cluster, middle, accumulated);
        last = {glm::vec3(middle), static_cast<float>(bound.lower - accumulated.displacement),
                accumulated.turn, false};
    }

    DistanceBound query_children(SurfaceQueryCache& cache, const AccumulatedMotion& motion, std::size_t level,
                                 const SampleCluster& cluster, const Vec3& middle,
                                 const SampleMotion& accumulated) const {
        const double all = lower_bound_of(cluster, middle);
        if (all > band_) return {all + accumulated.displacement, infinite_distance};
        DistanceBound bound{infinite_distance, infinite_distance};
        for (std::uint32_t k = cluster.begin; k < cluster.end; ++k) {
            visit(cache, motion, level - 1, k);
            const DistanceBound& child = cache.levels[level - 1][k];
            const double child_displacement = motion_of(samples_.levels[level - 1][k], motion).displacement;
            bound =
                min_bound(bound, {child.lower - child_displacement + accumulated.displacement, child.turn});
        }
        return bound;
    }

    // The lower bound that a cached query gives for the present position.
    static double updated_bound(const CachedQuery& last, const Vec3& middle, double radius,
                                const SampleMotion& accumulated) {
        const double displacement =
            glm::length(middle - Vec3(last.at)) + radius * (accumulated.turn - last.turned);
        return static_cast<double>(last.lower) - displacement - rounding_in_float;
    }

    [[nodiscard]] bool holds(const DistanceBound& bound, const SampleMotion& accumulated) const {
        const bool distance_holds = bound.lower - accumulated.displacement > band_;
        const bool turn_holds = bound.turn > accumulated.turn;
        return distance_holds & turn_holds;
    }
    static DistanceBound min_bound(const DistanceBound& a, const DistanceBound& b) {
        return {std::min(a.lower, b.lower), std::min(a.turn, b.turn)};
    }
    // Lower bound of the signed distance of all samples of a cluster, without a query of the surface.
    [[nodiscard]] double lower_bound_of(const SampleCluster& all, const Vec3& middle) const {
        const double lower = std::max(distance_to_box(middle), query(octree_, middle, cursor_).lower);
        return lower - all.radius - rounding;
    }
    [[nodiscard]] double distance_to_box(const Vec3& p) const {
        const double gap =
            glm::length(glm::max(glm::max(surface_.box.low - p, p - surface_.box.high), Vec3(0.0)));
        return gap > 0.0 ? gap : no_bound;
    }

    // Queries those samples of a cluster whose bounds no longer hold. `remaining`: m, what remains of the
    // cluster's own bound. If a sample was near at the last query, a new bound of the whole cluster is
    // unlikely to help and is not computed.
    DistanceBound query_cluster(SurfaceQueryCache& cache, const SampleCluster& cluster, const Vec3& middle,
                                double remaining, bool near_before, const SampleMotion& accumulated) const {
        const std::span<DistanceBound> sample_bounds =
            std::span(cache.samples).subspan(cluster.begin, cluster.end - cluster.begin);
        std::uint32_t pending = 0;  // one bit per sample; branch-free, because the outcome is unpredictable
        for (std::size_t i = 0; i < sample_bounds.size(); ++i)
            pending |= static_cast<std::uint32_t>(!holds(sample_bounds[i], accumulated)) << i;
        if (static_cast<std::size_t>(std::popcount(pending)) > individual_queries && !near_before) {
            const double all = cluster_bound(cluster, middle, remaining);
            if (all > band_) return {all + accumulated.displacement, infinite_distance};
        }
        for (; pending != 0; pending &= pending - 1)
            query_sample(cache, cluster.begin + static_cast<std::uint32_t>(std::countr_zero(pending)),
                         accumulated);
        DistanceBound bound{infinite_distance, infinite_distance};
        for (const DistanceBound& p : sample_bounds) bound = min_bound(bound, p);
        return bound;
    }

    [[nodiscard]] double cluster_bound(const SampleCluster& cluster, const Vec3& middle, double bound) const {
        const double all = lower_bound_of(cluster, middle);
        if (!octree_.nodes.empty() || all > band_ + cluster_lookahead) return all;
        const double radius =
            std::max(all, bound) > 0.0 ? cluster.radius + band_ + cluster_lookahead : infinite_distance;
        const double distance = query_point(surface_, middle, radius, 0.0, {}).distance;
        return std::max(all, std::min(distance, radius) - cluster.radius - rounding);
    }

    // Queries a sample whose bound no longer holds.
    void query_sample(SurfaceQueryCache& cache, std::uint32_t index, const SampleMotion& accumulated) const {
        ++collected_.query_cost;
        const SurfaceSample& sample = samples_.samples[index];
        const Vec3 at = to_surface_ * sample.at;
        if (sample.piece == SurfaceSample::no_piece)
            query_point_sample(cache, index, at, accumulated.displacement);
        else
            query_edge_piece(cache, index, samples_.pieces[sample.piece], at, accumulated);
    }

    void query_edge_piece(SurfaceQueryCache& cache, std::uint32_t index, const PieceExtent& piece,
                          const Vec3& at, const SampleMotion& accumulated) const {
        DistanceBound& bound = cache.samples[index];
        CachedQuery& last = cache.sample_queries[index];
        bound.lower = std::max(
            bound.lower, updated_bound(last, at, piece.half_length, accumulated) + accumulated.displacement);
        if (holds(bound, accumulated)) return;
        const double lower = query(octree_, at, cursor_).lower - piece.half_length - rounding;
        if (lower > band_) {
            bound = {lower + accumulated.displacement, infinite_distance};
            last = {glm::vec3(at), static_cast<float>(lower), accumulated.turn, false};
        } else {
            query_edge(index, piece, at, bound, last, cache.edges[samples_.samples[index].piece],
                       accumulated);
        }
    }

    void query_point_sample(SurfaceQueryCache& cache, std::uint32_t index, const Vec3& at,
                            double accumulated) const {
        double& lower = cache.samples[index].lower;
        CachedQuery& last = cache.sample_queries[index];
        const double displacement = glm::length(at - Vec3(last.at)) + rounding_in_float;
        lower = std::max(lower, static_cast<double>(last.lower) - displacement + accumulated);
        if (lower - accumulated > band_) return;
        const OctreeQuery octree_query = query(octree_, at, cursor_);
        lower = std::max(lower, octree_query.lower - rounding + accumulated);
        if (lower - accumulated > band_) {
            last = {glm::vec3(at), static_cast<float>(lower - accumulated), 0.0, false};
            return;
        }
        const bool outside = lower - accumulated > 0.0;
        std::array<SeparatingPlane, max_planes> planes;
        if (octree_query.leaf != nullptr && band_ <= octree_query.unlisted_distance) {
            if (outside && defer(index, at, octree_query, lower - accumulated, accumulated)) return;
            const std::optional<PointQueryResult> near =
                query_listed(surface_, octree_, octree_query, at, band_, planes);
            if (near) return store_result(cache, index, at, accumulated, *near, near->distance, planes);
            if (outside) {
                store_bound(cache, index, at, octree_query.unlisted_distance, accumulated);
                return;
            }
        }
        double radius = outside ? band_ + sample_lookahead : infinite_distance;
        const double upper =
            last.lower <= 0.0F ? displacement - static_cast<double>(last.lower) : infinite_distance;
        radius = std::min(radius, std::max(band_, std::min(octree_query.upper, upper) + rounding));
        const PointQueryResult near = query_point(surface_, at, radius, band_, planes);
        store_result(cache, index, at, accumulated, near, std::min(near.distance, radius), planes);
    }
    // Stores a signed distance as the sample's bound. Positive: no surface is nearer. Negative: a surface is
    // within its absolute value.
    static void store_bound(SurfaceQueryCache& cache, std::uint32_t index, const Vec3& at, double distance,
                            double accumulated) {
        cache.samples[index].lower = distance - rounding + accumulated;
        cache.sample_queries[index] = {glm::vec3(at), static_cast<float>(distance), 0.0, false};
    }
    void store_result(SurfaceQueryCache& cache, std::uint32_t index, const Vec3& at, double accumulated,
                      const PointQueryResult& near, double distance,
                      std::span<const SeparatingPlane> planes) const {
        collected_.complete_within = std::min(collected_.complete_within, near.complete_within);
        store_bound(cache, index, at, distance, accumulated);
        for (std::size_t i = 0; i < near.planes; ++i) collected_.add(contact_of(index, at, planes[i]));
    }
    [[nodiscard]] Contact contact_of(std::uint32_t index, const Vec3& at,
                                     const SeparatingPlane& plane) const {
        const Vec3 on_surface = to_assembly_ * plane.point;
        const Vec3 on_sample = to_assembly_ * at;
        const Vec3 normal = to_assembly_.turned(plane.normal);
        return {.on_tool = of_tool_ ? on_sample : on_surface,
                .on_obstacle = of_tool_ ? on_surface : on_sample,
                .normal = of_tool_ ? normal : -normal,
                .distance = plane.distance,
                .obstacle = obstacle_at(index, plane.triangle),
                .feature = of_tool_ ? index : index | of_obstacle,
                .triangle = plane.triangle};
    }
    [[nodiscard]] ObstacleId obstacle_at(std::uint32_t index, std::uint32_t triangle) const {
        return obstacle_of(world_, body_, of_tool_ ? triangle : samples_.samples[index].triangle);
    }

    // Defers the contact of a point outside. In a convex leaf the point has at most one contact, whose
    // position and normal are bounded. False if the leaf is not convex, its normals spread too far, or
    // the buffer is full.
    [[nodiscard]] bool defer(std::uint32_t index, const Vec3& at, const OctreeQuery& octree_query,
                             double lower, double accumulated) const {
        if (!octree_query.leaf->convex || octree_query.leaf->spread > max_normal_spread) return false;
        const Vec3 normal = to_assembly_.turned(octree_query.leaf->normal);
        return collected_.defer({.lower = lower,
                                 .on_tool = to_assembly_ * at,
                                 .normal = of_tool_ ? normal : -normal,
                                 .position_error = static_cast<float>(of_tool_ ? rounding : band_ + rounding),
                                 .spread = octree_query.leaf->spread,
                                 .obstacle = obstacle_at(index, octree_.triangles[octree_query.leaf->begin]),
                                 .sample = index,
                                 .accumulated = accumulated,
                                 .body = body_index_,
                                 .of_tool = of_tool_});
    }

    void query_edge(std::uint32_t index, const PieceExtent& edge, const Vec3& at, DistanceBound& bound,
                    CachedQuery& last, EdgeCache& edges, const SampleMotion& accumulated) const {
        const EdgePiece piece{at,
                              to_surface_.turned(edge.half),
                              {to_surface_.turned(edge.inward[0]), to_surface_.turned(edge.inward[1])}};
        std::array<Crossing, max_planes> crossings;
        bool searched = false;
        const EdgeQueryResult found =
            query_edges_cached(surface_, piece, tool_, from_surface_, accumulated.turn, band_, last.edge_near,
                               edges, searched, crossings);
        if (searched) collected_.query_cost += edge_search_cost;
        collected_.complete_within = std::min(collected_.complete_within, found.complete_within);
        bound = {found.clear_distance - rounding + accumulated.displacement,
                 found.clear_turn + accumulated.turn};
        last = {glm::vec3(at), static_cast<float>(found.clear_distance), accumulated.turn,
                found.clear_distance < short_lookahead};
        for (std::size_t i = 0; i < found.count; ++i) {
            const Crossing& crossing = crossings[i];
            const std::uint32_t triangle = surface_.mesh.sharp_edges[crossing.edge].triangle;
            collected_.add({.on_tool = to_assembly_ * crossing.on_piece,
                            .on_obstacle = to_assembly_ * crossing.on_edge,
                            .normal = to_assembly_.turned(crossing.normal),
                            .distance = crossing.distance,
                            .obstacle = obstacle_of(world_, body_, triangle),
                            .feature = index,
                            .triangle = triangle});
        }
    }

    const CollisionWorld& world_;
    const Body& body_;
    std::uint32_t body_index_;
    const Solid& tool_;
    const SurfaceSamples& samples_;
    const Solid& surface_;
    const TriangleOctree& octree_;  // of the surface; may be empty
    Pose from_surface_;             // surface to samples
    PoseMatrix to_surface_;         // samples to surface
    PoseMatrix to_assembly_;        // surface to assembly
    bool of_tool_;                  // the samples are the tool's
    double band_;
    ContactCollector& collected_;
    mutable OctreeCursor cursor_;
};

// Returns true if bounding volumes prove that there is no contact within the band.
bool is_out_of_reach(const Solid& tool, const Solid& body, const Pose& to_body, double band) {
    const Vec3 middle = to_body * tool.middle;
    const Vec3 outside = glm::max(glm::max(body.box.low - middle, middle - body.box.high), Vec3(0.0));
    return glm::length(outside) > tool.radius + band + rounding;
}

}  // namespace

NarrowPhaseState make_narrow_phase(const CollisionWorld& world, const ToolShape& tool) {
    NarrowPhaseState state;
    for (const Body& body : world.bodies) {
        PairCache& pair = state.pairs.emplace_back();
        reset(pair.of_tool, tool.samples);
        reset(pair.of_body, world.shapes[body.shape].samples);
    }
    state.near.resize(4096);
    state.order.resize(state.near.size());
    state.kept.resize(state.near.size());
    state.kept_in.resize(state.near.size());
    state.deferred.resize(8192);
    state.deferred_order.resize(state.deferred.size());
    return state;
}

void clear_cache(NarrowPhaseState& state, const CollisionWorld& world, const ToolShape& tool) {
    for (std::size_t i = 0; i < state.pairs.size(); ++i) {
        PairCache& pair = state.pairs[i];
        if (pair.empty) continue;
        pair.empty = true;
        pair.moved = pair.turned = 0.0;
        reset(pair.of_tool, tool.samples);
        reset(pair.of_body, world.shapes[world.bodies[i].shape].samples);
    }
}

ContactQueryResult find_contacts(const CollisionWorld& world, const ToolShape& tool, const Pose& pose,
                                 double band, NarrowPhaseState& state, std::span<Contact> out) {
    ContactCollector collected{state.near, 0, band, state.deferred, 0};
    const auto surface_pass = [&](std::size_t i, bool of_tool, const Pose& to_body, const Pose& to_tool) {
        const Body& body = world.bodies[i];
        const CollisionShape& shape = world.shapes[body.shape];
        const auto index = static_cast<std::uint32_t>(i);
        return of_tool ? SurfaceQueryPass(world, body, index, tool.solid, tool.samples, shape.solid,
                                          shape.octree, to_body, body.pose, true, band, collected)
                       : SurfaceQueryPass(world, body, index, tool.solid, shape.samples, tool.solid,
                                          tool.octree, to_tool, pose, false, band, collected);
    };
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (!body.enabled) continue;
        const Pose to_body = inverse(body.pose) * pose;
        if (is_out_of_reach(tool.solid, world.shapes[body.shape].solid, to_body, band)) continue;
        PairCache& pair_cache = state.pairs[i];
        accumulate_motion(pair_cache, to_body);
        const Pose to_tool = inverse(to_body);
        surface_pass(i, true, to_body, to_tool).run(pair_cache.of_tool, pair_cache, tool.origin_radius());
        surface_pass(i, false, to_body, to_tool).run(pair_cache.of_body, pair_cache, tool.origin_radius());
    }
    const auto resolve = [&](const DeferredContact& one, Contact& contact) {
        PairCache& pair_cache = state.pairs[one.body];
        const Pose to_tool = inverse(pair_cache.last);
        return surface_pass(one.body, one.of_tool, pair_cache.last, to_tool)
            .resolve(one, one.of_tool ? pair_cache.of_tool : pair_cache.of_body, contact);
    };
    ContactQueryResult found =
        reduce_contacts({state.near, collected.count, state.order, state.kept, state.kept_in,
                         std::span(state.deferred).first(collected.deferred_count), state.deferred_order,
                         collected.complete_within},
                        resolve, out);
    found.query_cost = collected.query_cost;
    return found;
}

}  // namespace bolt::collision
