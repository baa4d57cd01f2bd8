// Plans a path for the guiding force around obstacles. The caller supplies the line-of-sight query (Embree,
// in the servo), so the force never pulls through a housing.
#pragma once

#include <array>
#include <cstddef>

#include "engine/base/function_ref.hpp"
#include "engine/base/math.hpp"

namespace bolt::force {

// Returns true if the straight segment is free. It may include a margin as wide as the tool.
using IsSegmentFree = FunctionRef<bool(const Vec3& from, const Vec3& to)>;

struct GuideTarget {
    Vec3 point{0.0};           // m, goal of the tool
    Vec3 axis{0.0, 1.0, 0.0};  // unit, towards the accessible side
    double approach = 0.08;    // m above the point at which the last segment begins
    double shell = 0.03;       // m, radius of the ball that the target's nut and bolt fill; not an obstacle
};

struct GuidePath {
    std::array<Vec3, 5> points{};  // from the tool to the target
    std::size_t count = 0;         // 0: no path found
};

// Candidates: straight, if that arrives along the axis or level from the side; via the approach point; over
// the target at several heights; around one side. Returns the shortest free candidate. If none is free,
// returns the straight segment if that is free, else an empty path. Queries `free` at most 100 times.
GuidePath plan_path(const Vec3& from, const GuideTarget& target, IsSegmentFree free);

// The lowest height above the target, m, to which the tool may be led from its present position. The queries
// treat the tool as a line, but it is wide: near the target it is known to fit only along the axis. So it is
// led level until it is inside a cone about the axis, then down.
double lowest_ahead(const GuideTarget& target, const Vec3& tool);

// Moves the end of the path, and the approach point if there is one, to the target's present position.
void move_end(GuidePath& path, const GuideTarget& target);

double length(const GuidePath& path);
Vec3 point_at(const GuidePath& path, double along);  // `along` in m from the start, clamped

// `free` for the segment without the ball of the target's own nut and bolt.
bool free_to(const Vec3& from, const Vec3& to, const GuideTarget& target, IsSegmentFree free);

}  // namespace bolt::force
