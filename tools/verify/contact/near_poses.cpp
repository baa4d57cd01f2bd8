#include "tools/verify/contact/near_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>

#include "engine/base/random.hpp"

namespace bolt::contact_validation {

using namespace contact_oracle;

namespace {

constexpr double mm = 1e-3, um = 1e-6;
constexpr std::size_t around_each = 20;
constexpr double deep = 0.1 * mm, margin = 0.1 * mm;
constexpr std::uint32_t of_obstacle = 0x80000000U;  // the top bit of Contact::feature

Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}
Vec3 random_direction(Random& random) { return random_turn(random) * Vec3(1, 0, 0); }

Vec3 random_point(const Surface& surface, Random& random) {
    const std::vector<geometry::Triangle>& triangles = surface.tree.triangles();
    const geometry::Triangle& t = triangles[random.bits() % triangles.size()];
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    return (1.0 - u) * t.a + u * (1.0 - v) * t.b + u * v * t.c;
}

struct Place {
    Pose tool;
    Vec3 at;  // where it touches, roughly
};

// Some point of the tool at some point of a part, come to along some way from outside until anything touches.
std::optional<Place> come_to(const Scene& scene, const collision::World& world, Random& random) {
    constexpr double far = 0.4, near = 1 * um;
    const Part& part = scene.parts[random.bits() % scene.parts.size()];
    const Pose turned{Vec3(0.0), random_turn(random)};
    const Vec3 target = world.bodies[part.body].pose * random_point(part.surface, random);
    const Vec3 on_tool = random_point(scene.tool, random);
    const Vec3 way = random_direction(random);
    double s = -far;
    while (s < 3 * mm) {
        const Pose tool{target - turned.orientation * on_tool + s * way, turned.orientation};
        const Meeting met = meet(scene, world, tool, {.reach = 30 * mm, .depths = {.enough = 0.0}});
        if (met.crosses) return std::nullopt;
        if (met.gap < near) return Place{tool, tool * on_tool};
        s += met.gap;
    }
    return std::nullopt;
}

Pose beside(const Place& place, Random& random) {
    const Quat turn = rotation(random.uniform(0.0, to_radians(1.0)) * random_direction(random));
    const Vec3 shift = random.uniform(0.0, 1.5 * mm) * random_direction(random);
    return {place.at + turn * (place.tool.position - place.at) + shift,
            glm::normalize(turn * place.tool.orientation)};
}

// Signed, to the nearest part of a body.
double distance_to(const Scene& scene, const collision::World& world, std::size_t body, const Vec3& point) {
    const Vec3 p = inverse(world.bodies[body].pose) * point;
    double least = 1.0;
    for (const Part& part : scene.parts)
        if (part.body == body) least = std::min(least, signed_distance(part.surface, p, 1.0));
    return least;
}

std::size_t body_of(const Scene& scene, collision::ObstacleId id) {
    const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                   [id](const Part& candidate) { return candidate.id == id; });
    return part->body;
}

// Of a point of either side and not of a piece of an edge.
bool of_point(const Scene& scene, const collision::World& world, const collision::ToolShape& tool,
              const collision::Contact& c) {
    const collision::Samples& samples =
        (c.feature & of_obstacle) == 0 ? tool.samples
                                       : world.shapes[world.bodies[body_of(scene, c.obstacle)].shape].samples;
    return samples.samples[c.feature & ~of_obstacle].piece == collision::Sample::no_piece;
}

void hold_against(const Scene& scene, const collision::World& world, const collision::ToolShape& tool,
                  std::span<const collision::Contact> contacts, NearPose& pose) {
    const Pose to_tool = inverse(pose.tool);
    for (const collision::Contact& c : contacts) {
        double from_obstacle = 1.0;
        for (const Part& part : scene.parts)
            if (part.id == c.obstacle)
                from_obstacle =
                    std::min(from_obstacle,
                             nearest(part.surface.tree, inverse(world.bodies[part.body].pose) * c.on_obstacle,
                                     from_obstacle)
                                 .distance);
        const double from_tool = nearest(scene.tool.tree, to_tool * c.on_tool, 1.0).distance;
        const double length = glm::length(c.on_tool - c.on_obstacle) - std::abs(c.distance);
        double& off = of_point(scene, world, tool, c) ? pose.off : pose.off_edges;
        off = std::max({off, from_obstacle, from_tool, std::abs(length)});
    }
    // Of the nearest, if a point of one is told of and no crossing of edges, the very distance.
    const collision::Contact& c = contacts.front();
    if (!of_point(scene, world, tool, c)) return;
    const Vec3 on_tool = to_tool * c.on_obstacle;
    double truth = signed_distance(scene.tool, on_tool, 1.0);
    if ((c.feature & of_obstacle) == 0) {
        truth = 1.0;
        for (std::size_t b = 0; b < world.bodies.size(); ++b)
            truth = std::min(truth, distance_to(scene, world, b, c.on_tool));
    }
    pose.wrong = std::abs(c.distance - truth);
}

void look_at(const Scene& scene, const collision::World& world, const collision::ToolShape& tool, double band,
             collision::NarrowPhaseState& state, NearPose& pose) {
    std::array<collision::Contact, 32> contacts;
    const collision::ContactQueryResult found =
        collision::find_contacts(world, tool, pose.tool, band, state, contacts);
    const Looking looking{.reach = band + 10 * um, .depths = {.enough = 0.5 * mm, .tolerance = 0.5 * um}};
    pose.truth = meet(scene, world, pose.tool, looking);
    pose.points = meet_points(scene, world, pose.tool, pose.truth.crosses, looking);
    pose.found = found.count > 0;
    pose.told = pose.found ? contacts[0].distance : band;
    if (pose.found) hold_against(scene, world, tool, std::span(contacts).first(found.count), pose);
}

double quantile(std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0.0;
    return sorted[std::min(sorted.size() - 1,
                           static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

}  // namespace

std::vector<NearPose> near_poses(const Scene& scene, const collision::World& world,
                                 const collision::ToolShape& tool, const NearOptions& options) {
    std::vector<NearPose> all(options.poses);
    const std::size_t places = (options.poses + around_each - 1) / around_each;
    const auto work = [&](std::size_t first) {
        collision::NarrowPhaseState state = collision::make_narrow_phase(world, tool);
        for (std::size_t i = first; i < places; i += options.threads) {
            Random random(options.seed, i);
            collision::clear_cache(state, world, tool);
            std::optional<Place> place;
            while (!place) place = come_to(scene, world, random);
            for (std::size_t k = i * around_each; k < std::min(all.size(), (i + 1) * around_each); ++k) {
                all[k].tool = beside(*place, random);
                look_at(scene, world, tool, options.band, state, all[k]);
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work, i);
    work(0);
    for (std::thread& thread : threads) thread.join();
    return all;
}

bool told_outside(const NearPose& pose) {
    return pose.truth.depth > deep && !(pose.found && pose.told < 0.0);
}
bool missed(const NearPose& pose) { return pose.truth.depth > deep && !(pose.found && pose.told < margin); }

NearSummary summarize(const std::vector<NearPose>& poses, double band) {
    NearSummary sum;
    std::vector<double> later;
    for (const NearPose& pose : poses) {
        ++sum.poses;
        sum.off = std::max(sum.off, pose.off);
        sum.off_edges = std::max(sum.off_edges, pose.off_edges);
        sum.wrong = std::max(sum.wrong, pose.wrong);
        if (pose.truth.crosses) {
            ++sum.crossing;
            sum.deep += pose.truth.depth > deep ? 1U : 0U;
            sum.told_outside += told_outside(pose) ? 1U : 0U;
            sum.missed += missed(pose) ? 1U : 0U;
            if (!pose.found || pose.told >= 0.0)
                sum.deepest_untold = std::max(sum.deepest_untold, pose.truth.depth);
            if (pose.points.depth > 0.0)
                sum.shallower_than_points =
                    std::max(sum.shallower_than_points, pose.points.depth + pose.told);
            continue;
        }
        ++sum.free;
        sum.nearer = std::max(sum.nearer, std::min(band, pose.truth.gap) - pose.told);
        if (pose.truth.gap >= band) continue;
        ++sum.near;
        later.push_back(pose.told - pose.truth.gap);
        sum.later_than_points = std::max(sum.later_than_points, pose.told - std::min(band, pose.points.gap));
    }
    std::sort(later.begin(), later.end());
    sum.later = quantile(later, 1.0);
    sum.later_p50 = quantile(later, 0.5);
    sum.later_p99 = quantile(later, 0.99);
    const auto exact = std::upper_bound(later.begin(), later.end(), 1 * um) - later.begin();
    sum.within_micrometre =
        later.empty() ? 0.0 : static_cast<double>(exact) / static_cast<double>(later.size());
    return sum;
}

std::string to_text(const NearSummary& s) {
    return fmt::format(
        "{} near poses: {} free ({} of them within the band), {} crossing\n"
        "  contacts: points off their surfaces by {:.4f} um at most, pieces of edges by {:.1f} um; the "
        "nearest, if it is\n"
        "    of a point, wrong by {:.4f} um at most\n"
        "  gaps: told smaller than they are by {:.4f} um at most; later than the points by {:.4f} um, than "
        "the surfaces\n"
        "    by {:.1f} um at most (half {:.3f}, 99 % {:.1f} um; {:.1f} % within 1 um)\n"
        "  crossings: {} deeper than 0.1 mm, {} of them told to be outside, {} by 0.1 mm or more; the "
        "deepest\n"
        "    told to be outside {:.1f} um; shallower than the points by {:.4f} um at most\n",
        s.poses, s.free, s.near, s.crossing, 1e6 * s.off, 1e6 * s.off_edges, 1e6 * s.wrong, 1e6 * s.nearer,
        1e6 * s.later_than_points, 1e6 * s.later, 1e6 * s.later_p50, 1e6 * s.later_p99,
        100.0 * s.within_micrometre, s.deep, s.told_outside, s.missed, 1e6 * s.deepest_untold,
        1e6 * s.shallower_than_points);
}

std::string to_text(const Pose& pose) {
    const Vec3& p = pose.position;
    const Quat& q = pose.orientation;
    return fmt::format("at {:.9f} {:.9f} {:.9f} turned {:.9f} {:.9f} {:.9f} {:.9f}", p.x, p.y, p.z, q.w, q.x,
                       q.y, q.z);
}

}  // namespace bolt::contact_validation
