#include "haptics/contact/proximity.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "haptics/contact/reduce.hpp"

namespace bolt::contact {
namespace {

// A bound is proven this far beyond what is needed now, so that it lasts some ticks: further costs more to
// ask.
constexpr double cluster_lookahead = 4e-3;
constexpr double sample_lookahead = 0.5e-3;
// More than the rounding of poses and distances.
constexpr double rounding = 1e-9;
constexpr double nothing_proven = -1e9;

constexpr std::uint32_t of_obstacle = 0x80000000U;

void make_bounds(Bounds& bounds, const Samples& samples) {
    bounds.clusters.assign(samples.clusters.size(), nothing_proven);
    bounds.samples.assign(samples.samples.size(), nothing_proven);
}

void forget(PairBounds& pair) {
    pair.fresh = true;
    pair.moved = pair.turned = 0.0;
    for (Bounds* bounds : {&pair.of_tool, &pair.of_body}) {
        std::fill(bounds->clusters.begin(), bounds->clusters.end(), nothing_proven);
        std::fill(bounds->samples.begin(), bounds->samples.end(), nothing_proven);
    }
}

// Any point at r from the tool's origin has moved by no more than moved + turned × |r|.
void spend(PairBounds& pair, const Pose& pose) {
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

// The contacts found, with a fixed room: when it is full the furthest make place.
struct Collected {
    std::span<Contact> room;
    std::size_t count = 0;
    double complete;  // up to where they are all there are

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
struct Sweep {
    const World& world;
    const Body& body;
    const Samples& samples;
    const Solid& surface;
    const Pose& to_surface;   // from the samples' frame
    const Pose& to_assembly;  // from the surface's frame
    bool of_tool;             // whose samples these are
    double band;
    Collected& collected;

    void face_contacts(std::uint32_t index, const Vec3& at, std::span<const Side> sides) const {
        for (const Side& side : sides) {
            Contact contact;
            const Vec3 on_surface = to_assembly * side.point;
            const Vec3 on_sample = to_assembly * at;
            const Vec3 normal = to_assembly.orientation * side.normal;
            contact.on_tool = of_tool ? on_sample : on_surface;
            contact.on_obstacle = of_tool ? on_surface : on_sample;
            contact.normal = of_tool ? normal : -normal;
            contact.distance = side.distance;
            contact.body = of_tool ? obstacle_of(world, body, side.triangle) : obstacle_of_sample(index);
            contact.feature = of_tool ? index : index | of_obstacle;
            collected.add(contact);
        }
    }
    [[nodiscard]] std::int32_t obstacle_of_sample(std::uint32_t index) const {
        return obstacle_of(world, body, samples.samples[index].triangle);
    }
    void edge_contacts(std::uint32_t index, const Vec3& at) const {
        const Sample& sample = samples.samples[index];
        const EdgePiece piece{
            at,
            to_surface.orientation * sample.half,
            {to_surface.orientation * sample.inward[0], to_surface.orientation * sample.inward[1]}};
        std::array<Crossing, most_sides> crossings;
        const Crossings found = near_edges(surface, piece, band, crossings);
        collected.complete = std::min(collected.complete, found.complete);
        for (std::size_t i = 0; i < found.count; ++i) {
            const Crossing& crossing = crossings[i];
            Contact contact;
            contact.on_tool = to_assembly * crossing.on_piece;
            contact.on_obstacle = to_assembly * crossing.on_edge;
            contact.normal = to_assembly.orientation * crossing.normal;
            contact.distance = crossing.distance;
            contact.body = obstacle_of(world, body, surface.mesh.sharp_edges[crossing.edge].triangle);
            contact.feature = index;
            collected.add(contact);
        }
    }

    // A new lower bound of the sample's distance, of an edge piece's all along. `outside`: it is known to be.
    [[nodiscard]] double ask(std::uint32_t index, bool outside) const {
        const Sample& sample = samples.samples[index];
        const double half = of_tool ? sample.half_length : 0.0;
        const Vec3 at = to_surface * sample.at;
        const double radius = outside ? band + half + sample_lookahead : nothing_near;
        std::array<Side, most_sides> sides;
        const Near near = near_point(surface, at, radius, band, sides);
        collected.complete = std::min(collected.complete, near.complete);
        face_contacts(index, at, std::span(sides).first(near.sides));
        if (half > 0.0 && near.distance <= half + band) edge_contacts(index, at);
        return std::min(near.distance, radius) - half - rounding;
    }

    void run(Bounds& bounds, const PairBounds& way, double reach) const {
        for (std::size_t c = 0; c < samples.clusters.size(); ++c) {
            const Cluster& cluster = samples.clusters[c];
            // The samples of an obstacle see the tool move, all of it.
            const double spent = way.moved + way.turned * (of_tool ? cluster.reach : reach);
            const double proven = bounds.clusters[c] - spent;
            if (proven > band) continue;
            const Vec3 middle = to_surface * cluster.middle;
            const double radius = proven > 0.0 ? cluster.radius + band + cluster_lookahead : nothing_near;
            const double distance = std::min(near_point(surface, middle, radius, 0.0, {}).distance, radius) -
                                    cluster.radius - rounding;
            bounds.clusters[c] = std::max(proven, distance) + spent;
            if (distance > band) continue;
            double least = nothing_near;
            for (std::uint32_t i = cluster.begin; i < cluster.end; ++i) {
                const double sample_proven = std::max(bounds.samples[i] - spent, distance);
                bounds.samples[i] =
                    (sample_proven <= band ? ask(i, sample_proven > 0.0) : sample_proven) + spent;
                least = std::min(least, bounds.samples[i] - spent);
            }
            bounds.clusters[c] = std::max(bounds.clusters[c], least + spent);
        }
    }
};

// Whether the tool is so far from the body that there is no contact within the band.
bool far_apart(const Solid& tool, const Solid& body, const Pose& to_body, double band) {
    const Vec3 middle = to_body * tool.middle;
    const Vec3 outside = glm::max(glm::max(body.box.low - middle, middle - body.box.high), Vec3(0.0));
    return glm::length(outside) > tool.radius + band + rounding;
}

}  // namespace

ProximityState make_proximity(const World& world, const ToolShape& tool) {
    ProximityState state;
    for (const Body& body : world.bodies) {
        PairBounds& pair = state.pairs.emplace_back();
        make_bounds(pair.of_tool, tool.samples);
        make_bounds(pair.of_body, world.shapes[body.shape].samples);
    }
    state.near.resize(4096);
    return state;
}

void forget(ProximityState& state) {
    for (PairBounds& pair : state.pairs) forget(pair);
}

Found find_contacts(const World& world, const ToolShape& tool, const Pose& pose, double band,
                    ProximityState& state, std::span<Contact> out) {
    Collected collected{state.near, 0, band};
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        const Body& body = world.bodies[i];
        if (!body.on) continue;
        const Shape& shape = world.shapes[body.shape];
        const Pose to_body = inverse(body.pose) * pose;
        if (far_apart(tool.solid, shape.solid, to_body, band)) continue;
        PairBounds& pair = state.pairs[i];
        spend(pair, to_body);
        const Pose to_tool = inverse(to_body);
        const Sweep of_tool{world,     body, tool.samples, shape.solid, to_body,
                            body.pose, true, band,         collected};
        of_tool.run(pair.of_tool, pair, tool.reach());
        const Sweep of_body{world, body, shape.samples, tool.solid, to_tool, pose, false, band, collected};
        of_body.run(pair.of_body, pair, tool.reach());
    }
    return reduce(std::span(state.near).first(collected.count), collected.complete, out);
}

}  // namespace bolt::contact
