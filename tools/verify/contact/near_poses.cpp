#include "tools/verify/contact/near_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <thread>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"

namespace bolt::contact_validation {

using namespace contact_oracle;

namespace {

constexpr std::size_t poses_per_approach = 20;
constexpr double deep = 0.1 * mm, margin = 0.1 * mm;
constexpr std::uint32_t obstacle_bit = 0x80000000U;  // the top bit of Contact::feature

Vec3 random_point(const ClosedSurface& surface, Random& random) {
    const std::vector<geometry::Triangle>& triangles = surface.tree.triangles();
    const geometry::Triangle& t = triangles[random.bits() % triangles.size()];
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    return (1.0 - u) * t.a + u * (1.0 - v) * t.b + u * v * t.c;
}

struct TouchingPose {
    Pose tool;
    Vec3 at;  // the approximate contact point
};

// Moves a random point of the tool towards a random point of a part along a random direction, from outside,
// until the tool touches anything. Returns nothing if it starts inside or passes without a contact.
std::optional<TouchingPose> approach(const ContactScene& scene, const collision::CollisionWorld& world,
                                     Random& random) {
    constexpr double far = 0.4, near = 1 * um;
    const ObstaclePart& part = scene.parts[random.bits() % scene.parts.size()];
    const Pose turned{Vec3(0.0), random_turn(random)};
    const Vec3 target = world.bodies[part.body].pose * random_point(part.surface, random);
    const Vec3 on_tool = random_point(scene.tool, random);
    const Vec3 direction = random_direction(random);
    double s = -far;
    while (s < 3 * mm) {
        const Pose tool{target - turned.orientation * on_tool + s * direction, turned.orientation};
        const ExactContact exact =
            exact_contact(scene, world, tool, {.reach = 30 * mm, .depths = {.stop_depth = 0.0}});
        if (exact.crosses) return std::nullopt;
        if (exact.gap < near) return TouchingPose{tool, tool * on_tool};
        s += exact.gap;
    }
    return std::nullopt;
}

Pose perturbed(const TouchingPose& touching, Random& random) {
    const Quat turn = rotation(random.uniform(0.0, to_radians(1.0)) * random_direction(random));
    const Vec3 shift = random.uniform(0.0, 1.5 * mm) * random_direction(random);
    return {touching.at + turn * (touching.tool.position - touching.at) + shift,
            glm::normalize(turn * touching.tool.orientation)};
}

// Returns the signed distance from a point to the nearest part of a body.
double distance_to(const ContactScene& scene, const collision::CollisionWorld& world, std::size_t body,
                   const Vec3& point) {
    const Vec3 p = inverse(world.bodies[body].pose) * point;
    double least = 1.0;
    for (const ObstaclePart& part : scene.parts)
        if (part.body == body) least = std::min(least, signed_distance(part.surface, p, 1.0));
    return least;
}

std::size_t body_of(const ContactScene& scene, collision::ObstacleId id) {
    const auto part = std::find_if(scene.parts.begin(), scene.parts.end(),
                                   [id](const ObstaclePart& candidate) { return candidate.id == id; });
    return part->body;
}

// Returns whether the contact belongs to a sample point of either body, and not to a piece of an edge.
bool is_point_contact(const ContactScene& scene, const collision::CollisionWorld& world,
                      const collision::ToolShape& tool, const collision::Contact& c) {
    const collision::SurfaceSamples& samples =
        (c.feature & obstacle_bit) == 0
            ? tool.samples
            : world.shapes[world.bodies[body_of(scene, c.obstacle)].shape].samples;
    return samples.samples[c.feature & ~obstacle_bit].piece == collision::SurfaceSample::no_piece;
}

void compare_contacts(const ContactScene& scene, const collision::CollisionWorld& world,
                      const collision::ToolShape& tool, std::span<const collision::Contact> contacts,
                      NearPose& pose) {
    const Pose to_tool = inverse(pose.tool);
    for (const collision::Contact& c : contacts) {
        double from_obstacle = 1.0;
        for (const ObstaclePart& part : scene.parts)
            if (part.id == c.obstacle)
                from_obstacle =
                    std::min(from_obstacle,
                             nearest(part.surface.tree, inverse(world.bodies[part.body].pose) * c.on_obstacle,
                                     from_obstacle)
                                 .distance);
        const double from_tool = nearest(scene.tool.tree, to_tool * c.on_tool, 1.0).distance;
        const double length = glm::length(c.on_tool - c.on_obstacle) - std::abs(c.distance);
        double& error = is_point_contact(scene, world, tool, c) ? pose.point_error : pose.edge_error;
        error = std::max({error, from_obstacle, from_tool, std::abs(length)});
    }
    // Compare the exact distance for the nearest contact, if it belongs to a sample point.
    const collision::Contact& c = contacts.front();
    if (!is_point_contact(scene, world, tool, c)) return;
    const Vec3 on_tool = to_tool * c.on_obstacle;
    double truth = signed_distance(scene.tool, on_tool, 1.0);
    if ((c.feature & obstacle_bit) == 0) {
        truth = 1.0;
        for (std::size_t b = 0; b < world.bodies.size(); ++b)
            truth = std::min(truth, distance_to(scene, world, b, c.on_tool));
    }
    pose.distance_error = std::abs(c.distance - truth);
}

void evaluate(const ContactScene& scene, const collision::CollisionWorld& world,
              const collision::ToolShape& tool, double band, collision::NarrowPhaseState& state,
              NearPose& pose) {
    std::array<collision::Contact, 32> contacts;
    const collision::ContactQueryResult found =
        collision::find_contacts(world, tool, pose.tool, band, state, contacts);
    const OracleQuery query{.reach = band + 10 * um,
                            .depths = {.stop_depth = 0.5 * mm, .tolerance = 0.5 * um}};
    pose.truth = exact_contact(scene, world, pose.tool, query);
    pose.points = exact_contact_of_points(scene, world, pose.tool, pose.truth.crosses, query);
    pose.found = found.count > 0;
    pose.reported = pose.found ? contacts[0].distance : band;
    if (pose.found) compare_contacts(scene, world, tool, std::span(contacts).first(found.count), pose);
}

}  // namespace

std::vector<NearPose> near_poses(const ContactScene& scene, const collision::CollisionWorld& world,
                                 const collision::ToolShape& tool, const NearOptions& options) {
    std::vector<NearPose> all(options.poses);
    const std::size_t approaches = (options.poses + poses_per_approach - 1) / poses_per_approach;
    const auto work = [&](std::size_t first) {
        collision::NarrowPhaseState state = collision::make_narrow_phase(world, tool);
        for (std::size_t i = first; i < approaches; i += options.threads) {
            Random random(options.seed, i);
            collision::clear_cache(state, world, tool);
            std::optional<TouchingPose> touching;
            while (!touching) touching = approach(scene, world, random);
            for (std::size_t k = i * poses_per_approach;
                 k < std::min(all.size(), (i + 1) * poses_per_approach); ++k) {
                all[k].tool = perturbed(*touching, random);
                evaluate(scene, world, tool, options.band, state, all[k]);
            }
        }
    };
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < options.threads; ++i) threads.emplace_back(work, i);
    work(0);
    for (std::thread& thread : threads) thread.join();
    return all;
}

bool reported_outside(const NearPose& pose) {
    return pose.truth.depth > deep && !(pose.found && pose.reported < 0.0);
}
bool missed(const NearPose& pose) {
    return pose.truth.depth > deep && !(pose.found && pose.reported < margin);
}

NearSummary summarize(const std::vector<NearPose>& poses, double band) {
    NearSummary sum;
    std::vector<double> gap_overestimates;
    for (const NearPose& pose : poses) {
        ++sum.poses;
        sum.point_error = std::max(sum.point_error, pose.point_error);
        sum.edge_error = std::max(sum.edge_error, pose.edge_error);
        sum.distance_error = std::max(sum.distance_error, pose.distance_error);
        if (pose.truth.crosses) {
            ++sum.crossing;
            sum.deep += pose.truth.depth > deep ? 1U : 0U;
            sum.reported_outside += reported_outside(pose) ? 1U : 0U;
            sum.missed += missed(pose) ? 1U : 0U;
            if (!pose.found || pose.reported >= 0.0)
                sum.deepest_unreported = std::max(sum.deepest_unreported, pose.truth.depth);
            if (pose.points.depth > 0.0)
                sum.max_depth_underestimate_points =
                    std::max(sum.max_depth_underestimate_points, pose.points.depth + pose.reported);
            continue;
        }
        ++sum.free;
        sum.max_gap_underestimate =
            std::max(sum.max_gap_underestimate, std::min(band, pose.truth.gap) - pose.reported);
        if (pose.truth.gap >= band) continue;
        ++sum.near;
        gap_overestimates.push_back(pose.reported - pose.truth.gap);
        sum.max_gap_overestimate_points =
            std::max(sum.max_gap_overestimate_points, pose.reported - std::min(band, pose.points.gap));
    }
    std::sort(gap_overestimates.begin(), gap_overestimates.end());
    sum.max_gap_overestimate = quantile(gap_overestimates, 1.0);
    sum.gap_overestimate_p50 = quantile(gap_overestimates, 0.5);
    sum.gap_overestimate_p99 = quantile(gap_overestimates, 0.99);
    const auto exact = std::upper_bound(gap_overestimates.begin(), gap_overestimates.end(), 1 * um) -
                       gap_overestimates.begin();
    sum.within_micrometre = gap_overestimates.empty()
                                ? 0.0
                                : static_cast<double>(exact) / static_cast<double>(gap_overestimates.size());
    return sum;
}

std::string to_text(const NearSummary& s) {
    return fmt::format(
        "{} near poses: {} free ({} of them within the band), {} crossing\n"
        "  contacts: greatest position error {:.4f} um for points, {:.1f} um for edge pieces; greatest "
        "distance error\n"
        "    of a nearest point contact {:.4f} um\n"
        "  gaps: underestimated by at most {:.4f} um; overestimated by at most {:.4f} um against the sample "
        "points and\n"
        "    {:.1f} um against the surfaces (median {:.3f}, 99th percentile {:.1f} um; {:.1f} % within 1 "
        "um)\n"
        "  crossings: {} deeper than 0.1 mm, {} of them reported as outside, {} as outside by 0.1 mm or "
        "more; the deepest\n"
        "    reported as outside {:.1f} um; depth underestimated by at most {:.4f} um against the sample "
        "points\n",
        s.poses, s.free, s.near, s.crossing, 1e6 * s.point_error, 1e6 * s.edge_error, 1e6 * s.distance_error,
        1e6 * s.max_gap_underestimate, 1e6 * s.max_gap_overestimate_points, 1e6 * s.max_gap_overestimate,
        1e6 * s.gap_overestimate_p50, 1e6 * s.gap_overestimate_p99, 100.0 * s.within_micrometre, s.deep,
        s.reported_outside, s.missed, 1e6 * s.deepest_unreported, 1e6 * s.max_depth_underestimate_points);
}

std::string to_text(const Pose& pose) {
    const Vec3& p = pose.position;
    const Quat& q = pose.orientation;
    return fmt::format("at {:.9f} {:.9f} {:.9f} turned {:.9f} {:.9f} {:.9f} {:.9f}", p.x, p.y, p.z, q.w, q.x,
                       q.y, q.z);
}

}  // namespace bolt::contact_validation
