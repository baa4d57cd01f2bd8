#include "haptics/force/guide.hpp"

#include <algorithm>

namespace bolt::force {

namespace {

constexpr double carrot_speed = 0.6;  // m/s at which the point pulled to runs ahead
constexpr double patience = 0.25;     // s
constexpr double driven_back = 0.05;  // m
constexpr double soft = 0.01;         // m: nearer than this to a point on the way, the pull to it fades

double towards(double now, double wanted, double most) { return now + std::clamp(wanted - now, -most, most); }

// A way is looked for only where there is no force that could change by it.
void begin(GuideState& s, const Vec3& tool, const GuideGoal& goal, Free free, double dt) {
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
    // Its first piece is known to be free.
    if (s.path.count > 1) s.along = glm::length(s.path.points[1] - s.path.points[0]);
}

// The point that it pulls to runs ahead as far as the tool sees it and, down the axis, as far as `most`; back
// where it does not. False: it cannot be seen at all.
bool run_ahead(GuideState& s, const Vec3& tool, double most, Free free, double dt) {
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

// J that the springs at the end of the way hold: only there is it a potential.
double stored_in(const Guiding& g, const GuideState& s, const GuidedTool& tool) {
    const double aligning = aligning_potential(g.torque, s.goal.hexagon, tool.jaw, tool.normal);
    const double distance = glm::length(s.goal.target.point - tool.position);
    return (s.at_end ? s.strength * guiding_potential(g, distance) : 0.0) + s.alignment * aligning;
}

}  // namespace

Wanted guide(const Guiding& g, GuideState& s, const GuidedTool& tool, const GuideGoal& goal, Free free,
             double dt) {
    if (s.strength == 0.0 && s.alignment == 0.0 && (goal.id != s.goal.id || s.path.count == 0))
        begin(s, tool.position, goal, free, dt);
    if (s.path.count == 0) return {};
    const double stored_before =
        stored_in(g, s, tool);  // as all was in the tick before, with the tool as it is now
    const double led = s.at_end ? 0.0 : glm::dot(s.force, tool.position - s.tool);

    const bool here = goal.id >= 0 && goal.id == s.goal.id;
    if (here) {  // its nut comes down as it turns
        s.goal = goal;
        move_end(s.path, goal.target);
        if (s.at_end) s.along = s.farthest = length(s.path);
    }
    const double whole = length(s.path);
    // A way of one piece leads straight.
    const double most = s.path.count > 2 ? whole - lowest_ahead(s.goal.target, tool.position) : whole;
    s.along = std::min(s.along, whole);
    const bool seen = run_ahead(s, tool.position, most, free, dt);
    const double remaining = whole - s.along;
    s.at_end = remaining <= 0.0;
    const Vec3 away = point_at(s.path, s.along) - tool.position;
    const double distance = glm::length(away), left = distance + remaining;

    // Driven back, or come to the last point that can be seen: something stands in this way now, there may be
    // another. What waits for the tool to be over the target is neither.
    s.farthest = std::min(std::max(s.farthest, s.along), std::max(s.along, most));
    s.stuck = s.along < most && distance < 2.0 * soft ? s.stuck + dt : 0.0;
    const bool good = seen && s.farthest - s.along < driven_back && s.stuck < patience;

    const double wanted = here && good ? std::clamp(g.strength, 0.0, 1.0) : 0.0;
    s.strength = towards(s.strength, wanted, g.slew * dt);
    s.alignment = towards(s.alignment, left < g.near ? wanted : 0.0, g.slew * dt);

    // A point on the way is passed softly; at the end the law is exact.
    const double least = std::clamp(remaining, 1e-12, soft);
    s.force = away * (s.strength * guiding_pull(g, left) / std::max(distance, least));
    s.tool = tool.position;
    Wanted out;
    out.command.force = s.force;
    out.command.torque = s.alignment * aligning_torque(g.torque, s.goal.hexagon, tool.jaw, tool.normal);
    out.stored = stored_in(g, s, tool);
    out.granted = out.stored - stored_before + led;
    if (s.strength == 0.0 && s.alignment == 0.0 && !good) s.path = {};  // another way, when there is patience
    return out;
}

}  // namespace bolt::force
