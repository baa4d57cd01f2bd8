#include "haptics/force/guide.hpp"

#include <algorithm>

namespace bolt::force {

namespace {

constexpr double carrot_speed = 0.6;  // m/s of the pull point along the path
constexpr double patience = 0.25;  // s between two attempts to plan, and of `stuck` before a path is dropped
constexpr double driven_back = 0.05;  // m of retreat after which a path is dropped
constexpr double soft = 0.01;         // m to the pull point below which the pull fades, except at the target

double step_towards(double now, double target, double most) {
    return now + std::clamp(target - now, -most, most);
}

// Adopts the goal and plans a path. Called only while the force is zero, so that it stays continuous.
void begin(GuideState& s, const Vec3& tool, const GuideGoal& goal, IsSegmentFree free, double dt) {
    s.patience = std::max(0.0, s.patience - dt);
    if (goal.id < 0) {
        s = {};
        return;
    }
    if (goal.id == s.goal.id && s.patience > 0.0) return;
    s = {};
    s.goal = goal;
    s.path = plan_path(tool, goal.target, free);
    s.patience = patience;
    // The planner has checked that the first segment is free.
    if (s.path.count > 1) s.along = glm::length(s.path.points[1] - s.path.points[0]);
}

// Advances the pull point to at most `most` while it is in line of sight of the tool, and retracts it
// otherwise. Returns false if it is not in line of sight even then.
bool advance_pull_point(GuideState& s, const Vec3& tool, double most, IsSegmentFree free, double dt) {
    const GuideTarget& target = s.goal.target;
    const double step = carrot_speed * dt;
    s.along = std::min(s.along, std::max(most, s.along - 4.0 * step));
    const double ahead = std::max(s.along, std::min(s.along + step, most));
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
    const double aligning = aligning_potential(g.torque, s.goal.hexagon, tool.jaw, tool.normal);
    const double distance = glm::length(s.goal.target.point - tool.position);
    return (s.at_end ? s.strength * guiding_potential(g, distance) : 0.0) + s.alignment * aligning;
}

}  // namespace

ForceRequest guide(const GuidingParameters& g, GuideState& s, const GuidedTool& tool, const GuideGoal& goal,
                   IsSegmentFree free, double dt) {
    if (s.strength == 0.0 && s.alignment == 0.0 && (goal.id != s.goal.id || s.path.count == 0))
        begin(s, tool.position, goal, free, dt);
    if (s.path.count == 0) return {};
    const double stored_before =
        stored_in(g, s, tool);  // with the spring of the last tick and the tool of this one
    const double led = s.at_end ? 0.0 : glm::dot(s.force, tool.position - s.tool);

    const bool here = goal.id >= 0 && goal.id == s.goal.id;
    if (here) {  // the nut descends as it turns
        s.goal = goal;
        move_end(s.path, goal.target);
        if (s.at_end) s.along = s.farthest = length(s.path);
    }
    const double whole = length(s.path);
    // A path of one segment ends at the target itself.
    const double most = s.path.count > 2 ? whole - lowest_ahead(s.goal.target, tool.position) : whole;
    s.along = std::min(s.along, whole);
    const bool seen = advance_pull_point(s, tool.position, most, free, dt);
    const double remaining = whole - s.along;
    s.at_end = remaining <= 0.0;
    const Vec3 away = point_at(s.path, s.along) - tool.position;
    const double distance = glm::length(away), left = distance + remaining;

    // If the pull point was driven back, or the tool waits at it without sight beyond, an obstacle blocks
    // this path and another one may exist. A pull point held at `most` until the tool is above the target is
    // neither.
    s.farthest = std::min(std::max(s.farthest, s.along), std::max(s.along, most));
    s.stuck = s.along < most && distance < 2.0 * soft ? s.stuck + dt : 0.0;
    const bool good = seen && s.farthest - s.along < driven_back && s.stuck < patience;

    const double strength = here && good ? std::clamp(g.strength, 0.0, 1.0) : 0.0;
    s.strength = step_towards(s.strength, strength, g.slew * dt);
    s.alignment = step_towards(s.alignment, left < g.near ? strength : 0.0, g.slew * dt);

    // Softens the pull near a point of the path; at the target the law is exact.
    const double least = std::clamp(remaining, 1e-12, soft);
    s.force = away * (s.strength * guiding_pull(g, left) / std::max(distance, least));
    s.tool = tool.position;
    ForceRequest out;
    out.command.force = s.force;
    out.command.torque = s.alignment * aligning_torque(g.torque, s.goal.hexagon, tool.jaw, tool.normal);
    out.stored_energy = stored_in(g, s, tool);
    out.injected_energy = out.stored_energy - stored_before + led;
    if (s.strength == 0.0 && s.alignment == 0.0 && !good) s.path = {};  // plan another path after `patience`
    return out;
}

}  // namespace bolt::force
