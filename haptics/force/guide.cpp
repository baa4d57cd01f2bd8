#include "haptics/force/guide.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <initializer_list>

namespace bolt::force {

namespace {

// Distances at which the spring ends and the hyperbola k/d begins; between them the force is capped.
struct Ranges {
    double spring = 0.0, hyperbola = 0.0;  // m
};

Ranges ranges_of(const GuidingParameters& g) {
    const double d_min = std::sqrt(g.gain / g.stiffness);
    if (g.stiffness * d_min <= g.max_force) return {d_min, d_min};
    return {g.max_force / g.stiffness, g.gain / g.max_force};
}

std::complex<double> projected(const Hexagon& hexagon, const Vec3& jaw) {
    return {glm::dot(jaw, hexagon.flat), glm::dot(jaw, hexagon.across)};
}

std::complex<double> fifth_power(std::complex<double> z) { return z * (z * z) * (z * z); }

}  // namespace

double guiding_pull(const GuidingParameters& g, double distance) {
    const Ranges r = ranges_of(g);
    if (distance <= r.spring) return g.stiffness * distance;
    if (distance <= r.hyperbola) return g.max_force;
    return std::clamp(2.0 - distance / g.fade_distance, 0.0, 1.0) * g.gain / distance;
}

Vec3 guiding_force(const GuidingParameters& guiding, const Vec3& tool, const Vec3& target) {
    const Vec3 to_target = target - tool;
    const double d = glm::length(to_target);
    return d > 0.0 ? to_target * (guiding_pull(guiding, d) / d) : Vec3(0.0);
}

double guiding_potential(const GuidingParameters& g, double distance) {
    const Ranges r = ranges_of(g);
    if (distance <= r.spring) return 0.5 * g.stiffness * square(distance);
    double potential = 0.5 * g.stiffness * square(r.spring);
    potential += g.max_force * (std::min(distance, r.hyperbola) - r.spring);
    if (distance <= r.hyperbola) return potential;
    potential += g.gain * std::log(std::min(distance, g.fade_distance) / r.hyperbola);
    // Beyond the fade distance: the integral of (2 − d/fade_distance) k/d.
    const double outer = std::min(distance, 2.0 * g.fade_distance);
    if (outer > g.fade_distance)
        potential += g.gain * (2.0 * std::log(outer / g.fade_distance) - (outer / g.fade_distance - 1.0));
    return potential;
}

Vec3 aligning_torque(double max_torque, const Hexagon& h, const Vec3& jaw, const Vec3& normal) {
    // A rotation δ moves the jaw by δ × jaw and changes Re z⁶ by 6 Re(z⁵ δz).
    const std::complex<double> z5 = fifth_power(projected(h, jaw));
    const Vec3 about = z5.real() * glm::cross(jaw, h.flat) - z5.imag() * glm::cross(jaw, h.across);
    const Vec3 square_on = 2.0 * glm::dot(normal, h.axis) * glm::cross(normal, h.axis);
    return max_torque * (about + square_on);
}

double aligning_potential(double max_torque, const Hexagon& h, const Vec3& jaw, const Vec3& normal) {
    const std::complex<double> z = projected(h, jaw);
    return max_torque * ((1.0 - (fifth_power(z) * z).real()) / 6.0 + 1.0 - square(glm::dot(normal, h.axis)));
}

namespace {

constexpr double on_axis = 2.5e-3;  // m from the axis that counts as on the axis
constexpr double cone = 0.1;        // radius over height of the approach cone, 6°

// Position relative to the target, m: along its axis and perpendicular to it.
struct AxialOffset {
    double above, aside;
};

AxialOffset axial_offset(const GuideTarget& target, const Vec3& tool) {
    const Vec3 from = tool - target.point;
    const double above = glm::dot(from, target.axis);
    return {above, glm::length(from - above * target.axis)};
}

bool leads_straight(const GuideTarget& target, const Vec3& tool) {
    const AxialOffset offset = axial_offset(target, tool);
    return offset.above < 0.5 * target.bounding_radius || offset.aside <= on_axis + cone * offset.above;
}

GuidePath path_of(std::initializer_list<Vec3> points) {
    GuidePath path;
    for (const Vec3& p : points) path.points[path.count++] = p;
    return path;
}

bool all_free(const GuidePath& path, const GuideTarget& target, IsSegmentFree free) {
    for (std::size_t i = 1; i < path.count; ++i)
        if (!free_to(path.points[i - 1], path.points[i], target, free)) return false;
    return true;
}

}  // namespace

bool free_to(const Vec3& from, const Vec3& to, const GuideTarget& target, IsSegmentFree free) {
    const Vec3 way = to - from;
    const double distance = glm::length(way);
    if (distance <= 0.0) return true;
    const Vec3 direction = way / distance;
    const double nearest = glm::dot(target.point - from, direction);
    const double aside = glm::length(from + nearest * direction - target.point);
    if (aside >= target.bounding_radius) return free(from, to);
    // Query only the parts of the segment before and behind the ball around the target.
    const double half = std::sqrt(square(target.bounding_radius) - square(aside));
    const double in = nearest - half, out = nearest + half;
    if (in >= distance || out <= 0.0) return free(from, to);
    return (in <= 0.0 || free(from, from + in * direction)) &&
           (out >= distance || free(from + out * direction, to));
}

GuidePath plan_path(const Vec3& from, const GuideTarget& target, IsSegmentFree free) {
    const Vec3 above = target.point + target.axis * target.approach_height;
    const GuidePath straight = path_of({from, target.point});
    GuidePath best;
    double shortest = 0.0;
    const auto consider = [&](const GuidePath& path) {
        const double way = length(path);
        if (best.count > 0 && way >= shortest) return;
        if (!all_free(path, target, free)) return;
        best = path;
        shortest = way;
    };
    const bool is_free = all_free(straight, target, free);
    if (is_free && leads_straight(target, from)) return straight;
    if (!free_to(above, target.point, target, free)) return is_free ? straight : best;
    consider(path_of({from, above, target.point}));
    if (best.count > 0) return best;

    const Vec3 helper = std::abs(target.axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
    const Vec3 e1 = glm::normalize(helper - target.axis * glm::dot(helper, target.axis));
    const Vec3 e2 = glm::cross(target.axis, e1);
    const double from_height = glm::dot(from - above, target.axis);
    for (const double height : {0.06, 0.15, 0.3, 0.5}) {
        // Over the obstacle: up to a height above both ends, across, down.
        const double level = std::max(from_height, 0.0) + height;
        consider(path_of({from, from + target.axis * (level - from_height), above + target.axis * level,
                          above, target.point}));
        for (int i = 0; i < 8; ++i) {
            const double angle = i * (pi / 4.0);
            const Vec3 aside = height * (std::cos(angle) * e1 + std::sin(angle) * e2);
            consider(path_of({from, above + aside + 0.5 * height * target.axis, above, target.point}));
        }
    }
    return best.count == 0 && is_free ? straight : best;
}

double lowest_permitted_height(const GuideTarget& target, const Vec3& tool) {
    const AxialOffset offset = axial_offset(target, tool);
    return std::clamp(std::min((offset.aside - on_axis) / cone, offset.above), 0.0, target.approach_height);
}

void move_end(GuidePath& path, const GuideTarget& target) {
    if (path.count == 0) return;
    path.points[path.count - 1] = target.point;
    if (path.count > 2) path.points[path.count - 2] = target.point + target.axis * target.approach_height;
}

double length(const GuidePath& path) {
    double sum = 0.0;
    for (std::size_t i = 1; i < path.count; ++i) sum += glm::length(path.points[i] - path.points[i - 1]);
    return sum;
}

Vec3 point_at(const GuidePath& path, double along) {
    for (std::size_t i = 1; i < path.count; ++i) {
        const Vec3 leg = path.points[i] - path.points[i - 1];
        const double way = glm::length(leg);
        if (along < way) return path.points[i - 1] + leg * (std::max(along, 0.0) / way);
        along -= way;
    }
    return path.count == 0 ? Vec3(0.0) : path.points[path.count - 1];
}

namespace {

constexpr double pull_point_speed = 0.6;  // m/s of the pull point along the path
// s between two attempts to plan, and of `blocked_time` before a path is dropped.
constexpr double replan_interval = 0.25;
constexpr double driven_back = 0.05;  // m of retreat of the pull point after which a path is dropped
// m to the pull point below which the pull fades, except at the target.
constexpr double softening_radius = 0.01;

double step_towards(double now, double target, double max_step) {
    return now + std::clamp(target - now, -max_step, max_step);
}

// Adopts the target and plans a path. Called only while the force is zero, so that it stays continuous.
void begin(GuideState& s, const Vec3& tool, const GuideTarget& target, IsSegmentFree free, double dt) {
    s.time_to_replan = std::max(0.0, s.time_to_replan - dt);
    if (target.id < 0) {
        s = {};
        return;
    }
    if (target.id == s.target.id && s.time_to_replan > 0.0) return;
    s = {};
    s.target = target;
    s.path = plan_path(tool, target, free);
    s.time_to_replan = replan_interval;
    // The planner has checked that the first segment is free.
    if (s.path.count > 1) s.along = glm::length(s.path.points[1] - s.path.points[0]);
}

// Advances the pull point up to `limit` while it is in line of sight of the tool, and retracts it
// otherwise. Returns false if it is not in line of sight even then.
bool advance_pull_point(GuideState& s, const Vec3& tool, double limit, IsSegmentFree free, double dt) {
    const GuideTarget& target = s.target;
    const double step = pull_point_speed * dt;
    s.along = std::min(s.along, std::max(limit, s.along - 4.0 * step));
    const double ahead = std::max(s.along, std::min(s.along + step, limit));
    if (free_to(tool, point_at(s.path, ahead), target, free)) {
        s.along = ahead;
        return true;
    }
    if (free_to(tool, point_at(s.path, s.along), target, free)) return true;
    s.along = std::max(0.0, s.along - 4.0 * step);
    return free_to(tool, point_at(s.path, s.along), target, free);
}

// J stored in the springs at the target. Along the path the force is not a potential.
double stored_in(const GuidingParameters& g, const GuideState& s, const GuidedTool& tool) {
    const double aligning =
        aligning_potential(g.max_torque, s.target.hexagon, tool.head_direction, tool.normal);
    const double distance = glm::length(s.target.point - tool.position);
    return (s.at_end ? s.force_share * guiding_potential(g, distance) : 0.0) + s.torque_share * aligning;
}

}  // namespace

ForceRequest guide(const GuidingParameters& g, GuideState& s, const GuidedTool& tool,
                   const GuideTarget& target, IsSegmentFree free, double dt) {
    if (s.force_share == 0.0 && s.torque_share == 0.0 && (target.id != s.target.id || s.path.count == 0))
        begin(s, tool.position, target, free, dt);
    if (s.path.count == 0) return {};
    // Energy, J, of the last tick's spring at the tool's new position.
    const double stored_before = stored_in(g, s, tool);
    // J, work of the last tick's force along the path.
    const double guided_work = s.at_end ? 0.0 : glm::dot(s.force, tool.position - s.tool);

    const bool target_unchanged = target.id >= 0 && target.id == s.target.id;
    if (target_unchanged) {  // the nut descends as it turns
        s.target = target;
        move_end(s.path, target);
        if (s.at_end) s.along = s.max_along = length(s.path);
    }
    const double path_length = length(s.path);
    // A path of one segment ends at the target itself.
    const double limit =
        s.path.count > 2 ? path_length - lowest_permitted_height(s.target, tool.position) : path_length;
    s.along = std::min(s.along, path_length);
    const bool seen = advance_pull_point(s, tool.position, limit, free, dt);
    const double remaining = path_length - s.along;
    s.at_end = remaining <= 0.0;
    const Vec3 to_pull_point = point_at(s.path, s.along) - tool.position;
    const double distance = glm::length(to_pull_point), distance_left = distance + remaining;

    // The path is dropped if the pull point has retreated, or if the tool waits at it without line of sight
    // to the path beyond: an obstacle blocks this path, and another one may exist. A pull point that is held
    // at `limit` until the tool is above the target does not count.
    s.max_along = std::min(std::max(s.max_along, s.along), std::max(s.along, limit));
    s.blocked_time = s.along < limit && distance < 2.0 * softening_radius ? s.blocked_time + dt : 0.0;
    const bool path_usable = seen && s.max_along - s.along < driven_back && s.blocked_time < replan_interval;

    const double share = target_unchanged && path_usable ? std::clamp(g.mode_share, 0.0, 1.0) : 0.0;
    s.force_share = step_towards(s.force_share, share, g.fade_rate * dt);
    s.torque_share =
        step_towards(s.torque_share, distance_left < g.alignment_distance ? share : 0.0, g.fade_rate * dt);

    // Softens the pull near a point of the path; at the target the law is exact.
    const double min_distance = std::clamp(remaining, 1e-12, softening_radius);
    s.force =
        to_pull_point * (s.force_share * guiding_pull(g, distance_left) / std::max(distance, min_distance));
    s.tool = tool.position;
    ForceRequest out;
    out.command.force = s.force;
    out.command.torque =
        s.torque_share * aligning_torque(g.max_torque, s.target.hexagon, tool.head_direction, tool.normal);
    out.stored_energy = stored_in(g, s, tool);
    out.injected_energy = out.stored_energy - stored_before + guided_work;
    // Another path is planned after `time_to_replan`.
    if (s.force_share == 0.0 && s.torque_share == 0.0 && !path_usable) s.path = {};
    return out;
}

}  // namespace bolt::force
