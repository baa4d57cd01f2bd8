#include "haptics/collision/narrow_phase.hpp"

#include <algorithm>
#include <bit>
#include <glm/geometric.hpp>

namespace bolt::collision {
namespace {

// A bound is proven this far beyond what is needed now, so that it lasts some ticks: further costs more to
// ask.
constexpr double cluster_lookahead = 6e-3;
constexpr double sample_lookahead = 2.5e-3;
// So many spent samples of a cluster are asked one by one, more only if the cluster as a whole is near.
constexpr std::size_t few = 4;
// Takes as long as so many samples.
constexpr std::uint32_t edge_search_work = 10;
// More than the rounding of poses and distances.
constexpr double rounding = 1e-9;
constexpr double no_bound = -1e9;
// More than the rounding of positions and distances in float.
constexpr double rounding_in_float = 1e-6;

// Of a place (rad) whose normals spread further nothing is known.
constexpr float max_normal_spread = 1.2F;

void reset(Bounds& bounds, const Samples& samples) {
    constexpr DistanceBound nothing{no_bound, infinite_distance};
    bounds.levels.resize(samples.levels.size());
    for (std::size_t i = 0; i < samples.levels.size(); ++i)
        bounds.levels[i].assign(samples.levels[i].size(), nothing);
    constexpr CachedQuery unseen{glm::vec3(0.0F), static_cast<float>(no_bound), 0.0, false};
    bounds.level_queries.resize(samples.levels.size());
    for (std::size_t i = 0; i < samples.levels.size(); ++i)
        bounds.level_queries[i].assign(samples.levels[i].size(), unseen);
    bounds.samples.assign(samples.samples.size(), nothing);
    bounds.seen.assign(samples.samples.size(), unseen);
    bounds.edges.assign(samples.pieces.size(), {});
}

// Any point at r from the tool's origin has moved by no more than moved + turned × |r|.
void accumulate_motion(PairBounds& pair, const Pose& pose) {
    if (pair.fresh) {
        pair.fresh = false;
    } else {
        const Quat turn = glm::conjugate(pair.last.orientation) * pose.orientation;
        const double angle = 2.0 * std::atan2(glm::length(Vec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
        pair.moved += glm::length(pose.position - pair.last.position) + rounding;
        pair.turned += angle;
    }
    pair.last = pose;
}

// A pose as points are moved by it fastest.
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

// The contacts found, with a fixed room: when it is full the furthest make place.
struct ContactCollector {
    std::span<Contact> room;
    std::size_t count = 0;
    double complete;  // up to where they are all there are
    std::span<DeferredContact> deferred;
    std::size_t waiters = 0;
    std::uint32_t work = 0;

    bool wait(const DeferredContact& one) {
        if (waiters == deferred.size()) return false;
        deferred[waiters++] = one;
        return true;
    }

    void add(const Contact& contact) {
        if (count < room.size()) {
            room[count++] = contact;
            if (count == room.size()) std::make_heap(room.begin(), room.end(), nearer);
            return;
        }
        if (nearer(contact, room.front())) {
            complete = std::min(complete, room.front().distance);
            std::pop_heap(room.begin(), room.end(), nearer);
            room.back() = contact;
            std::push_heap(room.begin(), room.end(), nearer);
        } else {
            complete = std::min(complete, contact.distance);
        }
    }
};

// Samples of one side against the surface of the other.
class SurfaceQueryPass {
  public:
    SurfaceQueryPass(const World& world, const Body& body, std::uint32_t pair, const Solid& tool,
                     const Samples& samples, const Solid& surface, const TriangleOctree& octree,
                     const Pose& to_surface, const Pose& to_assembly, bool of_tool, double band,
                     ContactCollector& collected)
        : world_(world),
          body_(body),
          pair_(pair),
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

    // `reach`: of the tool, for what belongs to an obstacle sees all of the tool move.
    void run(Bounds& bounds, const PairBounds& way, double reach) const {
        const Way made{way.moved, way.turned, reach};
        const std::size_t top = samples_.levels.size() - 1;
        for (std::uint32_t i = 0; i < samples_.levels[top].size(); ++i) visit(bounds, made, top, i);
    }

    // What one waits for.
    bool find(const DeferredContact& one, Bounds& bounds, Contact& contact) const {
        const Vec3 at = to_surface_ * samples_.samples[one.sample].at;
        const OctreeQuery known = query(octree_, at);
        std::array<SeparatingPlane, 1> side;
        const auto near = query_listed(surface_, octree_, known, at, band_, side);
        if (!near) return false;
        see(bounds, one.sample, at, near->distance, one.spent);
        if (near->planes == 0) return false;
        contact = contact_of(one.sample, at, side[0]);
        return true;
    }

  private:
    struct Way {
        double moved, turned, reach;
    };
    [[nodiscard]] DistanceBound spent_on(const Cluster& cluster, const Way& way) const {
        return {way.moved + way.turned * (of_tool_ ? cluster.reach : way.reach), way.turned};
    }

    void visit(Bounds& bounds, const Way& way, std::size_t level, std::uint32_t i) const {
        const Cluster& cluster = samples_.levels[level][i];
        DistanceBound& bound = bounds.levels[level][i];
        const DistanceBound spent = spent_on(cluster, way);
        if (holds(bound, spent)) return;
        const Vec3 middle = to_surface_ * cluster.middle;
        CachedQuery& seen = bounds.level_queries[level][i];
        bound.lower = std::max(bound.lower, since(seen, middle, cluster.radius, spent) + spent.lower);
        if (holds(bound, spent)) return;
        const bool near_before =
            seen.lower > 0.5F * static_cast<float>(no_bound) && static_cast<double>(seen.lower) <= band_;
        bound = level == 0 ? open(bounds, cluster, middle, bound.lower - spent.lower, near_before, spent)
                           : divide(bounds, way, level, cluster, middle, spent);
        seen = {glm::vec3(middle), static_cast<float>(bound.lower - spent.lower), spent.turn, false};
    }

    DistanceBound divide(Bounds& bounds, const Way& way, std::size_t level, const Cluster& cluster,
                         const Vec3& middle, const DistanceBound& spent) const {
        const double all = far(cluster, middle);
        if (all > band_) return {all + spent.lower, infinite_distance};
        DistanceBound bound{infinite_distance, infinite_distance};
        for (std::uint32_t k = cluster.begin; k < cluster.end; ++k) {
            visit(bounds, way, level - 1, k);
            const DistanceBound& of_one = bounds.levels[level - 1][k];
            const double spent_on_one = spent_on(samples_.levels[level - 1][k], way).lower;
            bound = lesser(bound, {of_one.lower - spent_on_one + spent.lower, of_one.turn});
        }
        return bound;
    }

    // What a sighting proves now.
    static double since(const CachedQuery& seen, const Vec3& middle, double radius,
                        const DistanceBound& spent) {
        const double way = glm::length(middle - Vec3(seen.at)) + radius * (spent.turn - seen.turned);
        return static_cast<double>(seen.lower) - way - rounding_in_float;
    }

    [[nodiscard]] bool holds(const DistanceBound& proven, const DistanceBound& spent) const {
        const bool far = proven.lower - spent.lower > band_;
        const bool straight = proven.turn > spent.turn;
        return far & straight;
    }
    static DistanceBound lesser(const DistanceBound& a, const DistanceBound& b) {
        return {std::min(a.lower, b.lower), std::min(a.turn, b.turn)};
    }
    // A lower bound of the signed distance of all of a cluster without asking the surface.
    [[nodiscard]] double far(const Cluster& all, const Vec3& middle) const {
        const double lower = std::max(beside_box(middle), query(octree_, middle, cursor_).lower);
        return lower - all.radius - rounding;
    }
    [[nodiscard]] double beside_box(const Vec3& p) const {
        const double beside =
            glm::length(glm::max(glm::max(surface_.box.low - p, p - surface_.box.high), Vec3(0.0)));
        return beside > 0.0 ? beside : no_bound;
    }

    // A cluster whose bound is spent; `known`: what of it holds. If something of it was near before, the
    // cluster as a whole hardly is not.
    DistanceBound open(Bounds& bounds, const Cluster& cluster, const Vec3& middle, double known,
                       bool near_before, const DistanceBound& spent) const {
        const std::span<DistanceBound> proven =
            std::span(bounds.samples).subspan(cluster.begin, cluster.end - cluster.begin);
        std::uint32_t asked = 0;  // bit by bit; which they are can hardly be predicted
        for (std::size_t i = 0; i < proven.size(); ++i)
            asked |= static_cast<std::uint32_t>(!holds(proven[i], spent)) << i;
        if (static_cast<std::size_t>(std::popcount(asked)) > few && !near_before) {
            const double all = cluster_bound(cluster, middle, known);
            if (all > band_) return {all + spent.lower, infinite_distance};
        }
        for (; asked != 0; asked &= asked - 1)
            ask(bounds, cluster.begin + static_cast<std::uint32_t>(std::countr_zero(asked)), spent);
        DistanceBound bound{infinite_distance, infinite_distance};
        for (const DistanceBound& p : proven) bound = lesser(bound, p);
        return bound;
    }

    [[nodiscard]] double cluster_bound(const Cluster& cluster, const Vec3& middle, double proven) const {
        const double all = far(cluster, middle);
        if (!octree_.nodes.empty() || all > band_ + cluster_lookahead) return all;
        const double radius =
            std::max(all, proven) > 0.0 ? cluster.radius + band_ + cluster_lookahead : infinite_distance;
        const double distance = query_point(surface_, middle, radius, 0.0, {}).distance;
        return std::max(all, std::min(distance, radius) - cluster.radius - rounding);
    }

    // A sample whose bound is spent.
    void ask(Bounds& bounds, std::uint32_t index, const DistanceBound& spent) const {
        ++collected_.work;
        const Sample& sample = samples_.samples[index];
        const Vec3 at = to_surface_ * sample.at;
        if (sample.piece == Sample::no_piece)
            query_point_sample(bounds, index, at, spent.lower);
        else
            query_edge_piece(bounds, index, samples_.pieces[sample.piece], at, spent);
    }

    void query_edge_piece(Bounds& bounds, std::uint32_t index, const Piece& piece, const Vec3& at,
                          const DistanceBound& spent) const {
        DistanceBound& proven = bounds.samples[index];
        CachedQuery& seen = bounds.seen[index];
        proven.lower = std::max(proven.lower, since(seen, at, piece.half_length, spent) + spent.lower);
        if (holds(proven, spent)) return;
        const double far_from_all = query(octree_, at, cursor_).lower - piece.half_length - rounding;
        if (far_from_all > band_) {
            proven = {far_from_all + spent.lower, infinite_distance};
            seen = {glm::vec3(at), static_cast<float>(far_from_all), spent.turn, false};
        } else {
            query_edge(index, piece, at, proven, seen, bounds.edges[samples_.samples[index].piece], spent);
        }
    }

    void query_point_sample(Bounds& bounds, std::uint32_t index, const Vec3& at, double spent) const {
        double& lower = bounds.samples[index].lower;
        CachedQuery& seen = bounds.seen[index];
        const double way = glm::length(at - Vec3(seen.at)) + rounding_in_float;
        lower = std::max(lower, static_cast<double>(seen.lower) - way + spent);
        if (lower - spent > band_) return;
        const OctreeQuery known = query(octree_, at, cursor_);
        lower = std::max(lower, known.lower - rounding + spent);
        if (lower - spent > band_) {
            seen = {glm::vec3(at), static_cast<float>(lower - spent), 0.0, false};
            return;
        }
        const bool outside = lower - spent > 0.0;
        std::array<SeparatingPlane, max_planes> planes;
        if (known.leaf != nullptr && band_ <= known.unlisted) {
            if (outside && wait(index, at, known, lower - spent, spent)) return;
            const std::optional<PointQueryResult> near =
                query_listed(surface_, octree_, known, at, band_, planes);
            if (near) return note(bounds, index, at, spent, *near, near->distance, planes);
            if (outside) {
                see(bounds, index, at, known.unlisted, spent);
                return;
            }
        }
        double radius = outside ? band_ + sample_lookahead : infinite_distance;
        const double upper = seen.lower <= 0.0F ? way - static_cast<double>(seen.lower) : infinite_distance;
        radius = std::min(radius, std::max(band_, std::min(known.upper, upper) + rounding));
        const PointQueryResult near = query_point(surface_, at, radius, band_, planes);
        note(bounds, index, at, spent, near, std::min(near.distance, radius), planes);
    }
    // No surface is nearer than that; inside, one is as near.
    static void see(Bounds& bounds, std::uint32_t index, const Vec3& at, double distance, double spent) {
        bounds.samples[index].lower = distance - rounding + spent;
        bounds.seen[index] = {glm::vec3(at), static_cast<float>(distance), 0.0, false};
    }
    void note(Bounds& bounds, std::uint32_t index, const Vec3& at, double spent, const PointQueryResult& near,
              double distance, std::span<const SeparatingPlane> planes) const {
        collected_.complete = std::min(collected_.complete, near.complete);
        see(bounds, index, at, distance, spent);
        for (std::size_t i = 0; i < near.planes; ++i) collected_.add(contact_of(index, at, planes[i]));
    }
    [[nodiscard]] Contact contact_of(std::uint32_t index, const Vec3& at, const SeparatingPlane& side) const {
        const Vec3 on_surface = to_assembly_ * side.point;
        const Vec3 on_sample = to_assembly_ * at;
        const Vec3 normal = to_assembly_.turned(side.normal);
        return {.on_tool = of_tool_ ? on_sample : on_surface,
                .on_obstacle = of_tool_ ? on_surface : on_sample,
                .normal = of_tool_ ? normal : -normal,
                .distance = side.distance,
                .obstacle = obstacle_at(index, side.triangle),
                .feature = of_tool_ ? index : index | of_obstacle,
                .triangle = side.triangle};
    }
    [[nodiscard]] ObstacleId obstacle_at(std::uint32_t index, std::uint32_t triangle) const {
        return obstacle_of(world_, body_, of_tool_ ? triangle : samples_.samples[index].triangle);
    }

    // The point is outside; its contact, if it has one, is the one side of a convex place.
    [[nodiscard]] bool wait(std::uint32_t index, const Vec3& at, const OctreeQuery& known, double lower,
                            double spent) const {
        if (!known.leaf->convex || known.leaf->spread > max_normal_spread) return false;
        const Vec3 normal = to_assembly_.turned(known.leaf->normal);
        return collected_.wait({.lower = lower,
                                .on_tool = to_assembly_ * at,
                                .normal = of_tool_ ? normal : -normal,
                                .blur = static_cast<float>(of_tool_ ? rounding : band_ + rounding),
                                .spread = known.leaf->spread,
                                .obstacle = obstacle_at(index, octree_.triangles[known.leaf->begin]),
                                .sample = index,
                                .spent = spent,
                                .pair = pair_,
                                .of_tool = of_tool_});
    }

    void query_edge(std::uint32_t index, const Piece& edge, const Vec3& at, DistanceBound& proven,
                    CachedQuery& seen, EdgeCache& edges, const DistanceBound& spent) const {
        const EdgePiece piece{at,
                              to_surface_.turned(edge.half),
                              {to_surface_.turned(edge.inward[0]), to_surface_.turned(edge.inward[1])}};
        std::array<Crossing, max_planes> crossings;
        bool looked = false;
        const Crossings found = query_edges_cached(surface_, piece, tool_, from_surface_, spent.turn, band_,
                                                   seen.met, edges, looked, crossings);
        if (looked) collected_.work += edge_search_work;
        collected_.complete = std::min(collected_.complete, found.complete);
        proven = {found.clear - rounding + spent.lower, found.turn + spent.turn};
        seen = {glm::vec3(at), static_cast<float>(found.clear), spent.turn, found.clear < short_lookahead};
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

    const World& world_;
    const Body& body_;
    std::uint32_t pair_;
    const Solid& tool_;
    const Samples& samples_;
    const Solid& surface_;
    const TriangleOctree& octree_;  // of the surface; may be none
    Pose from_surface_;             // to the samples' frame
    PoseMatrix to_surface_;         // from there
    PoseMatrix to_assembly_;        // from the surface's frame
    bool of_tool_;                  // whose samples these are
    double band_;
    ContactCollector& collected_;
    mutable OctreeCursor cursor_;
};

// Whether the tool is so far from the body that there is no contact within the band.
bool far_apart(const Solid& tool, const Solid& body, const Pose& to_body, double band) {
    const Vec3 middle = to_body * tool.middle;
    const Vec3 outside = glm::max(glm::max(body.box.low - middle, middle - body.box.high), Vec3(0.0));
    return glm::length(outside) > tool.radius + band + rounding;
}

}  // namespace

NarrowPhaseState make_narrow_phase(const World& world, const ToolShape& tool) {
    NarrowPhaseState state;
    for (const Body& body : world.bodies) {
        PairBounds& pair = state.pairs.emplace_back();
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

void clear_cache(NarrowPhaseState& state, const World& world, const ToolShape& tool) {
    for (std::size_t i = 0; i < state.pairs.size(); ++i) {
        PairBounds& pair = state.pairs[i];
        pair.fresh = true;
        pair.moved = pair.turned = 0.0;
        reset(pair.of_tool, tool.samples);
        reset(pair.of_body, world.shapes[world.bodies[i].shape].samples);
    }
}

ContactQueryResult find_contacts(const World& world, const ToolShape& tool, const Pose& pose, double band,
                                 NarrowPhaseState& state, std::span<Contact> out) {
    ContactCollector collected{state.near, 0, band, state.deferred, 0};
    const auto sweep = [&](std::size_t i, bool of_tool, const Pose& to_body, const Pose& to_tool) {
        const Body& body = world.bodies[i];
        const Shape& shape = world.shapes[body.shape];
        const auto pair = static_cast<std::uint32_t>(i);
        return of_tool ? SurfaceQueryPass(world, body, pair, tool.solid, tool.samples, shape.solid,
                                          shape.octree, to_body, body.pose, true, band, collected)
                       : SurfaceQueryPass(world, body, pair, tool.solid, shape.samples, tool.solid,
                                          tool.octree, to_tool, pose, false, band, collected);
    };
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (!body.on) continue;
        const Pose to_body = inverse(body.pose) * pose;
        if (far_apart(tool.solid, world.shapes[body.shape].solid, to_body, band)) continue;
        PairBounds& known = state.pairs[i];
        accumulate_motion(known, to_body);
        const Pose to_tool = inverse(to_body);
        sweep(i, true, to_body, to_tool).run(known.of_tool, known, tool.reach());
        sweep(i, false, to_body, to_tool).run(known.of_body, known, tool.reach());
    }
    const auto find = [&](const DeferredContact& one, Contact& contact) {
        PairBounds& known = state.pairs[one.pair];
        const Pose to_tool = inverse(known.last);
        return sweep(one.pair, one.of_tool, known.last, to_tool)
            .find(one, one.of_tool ? known.of_tool : known.of_body, contact);
    };
    ContactQueryResult found = reduce_contacts(
        {state.near, collected.count, state.order, state.kept, state.kept_in,
         std::span(state.deferred).first(collected.waiters), state.deferred_order, collected.complete},
        find, out);
    found.work = collected.work;
    return found;
}

}  // namespace bolt::collision
