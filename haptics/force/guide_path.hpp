// A way for the guiding force that goes round what is in the way. Whether two points see each other is asked
// of somebody else (Embree, in the servo), so nothing is ever pulled through a casing.
#pragma once

#include <array>
#include <cstddef>

#include "engine/base/function_ref.hpp"
#include "engine/base/math.hpp"

namespace bolt::force {

// Whether the straight way is free. It may ask with a margin, as wide as the tool.
using Free = FunctionRef<bool(const Vec3& from, const Vec3& to)>;

struct GuideTarget {
    Vec3 point{0.0};           // m, where the tool is to be
    Vec3 axis{0.0, 1.0, 0.0};  // unit: the open side
    double approach = 0.08;    // m above the point, where the last piece of the way begins
    double shell = 0.03;       // m around the point that its own nut and bolt fill: no obstacle
};

struct GuidePath {
    std::array<Vec3, 5> points{};  // from the tool to the target
    std::size_t count = 0;         // 0: no way was found
};

// Straight, where that leads along the axis or level from the side; to the approach point and down; over it
// at some height; or round one side. The shortest of these that is free from end to end; straight all the
// same where none of them is. Asks at most 100 times.
GuidePath plan_path(const Vec3& from, const GuideTarget& target, Free free);

// m above the target: a tool there is not to be led lower than this yet. The ways are asked for as lines, a
// tool is wide, and near the target it is only along the axis that all of it is known to fit: level until it
// is within a cone about the axis, then down.
double lowest_ahead(const GuideTarget& target, const Vec3& tool);

// The way's end may move with the nut.
void move_end(GuidePath& path, const GuideTarget& target);

double length(const GuidePath& path);
Vec3 point_at(const GuidePath& path, double along);  // m from the beginning; clamped

// Free but for the target's own nut and bolt.
bool free_to(const Vec3& from, const Vec3& to, const GuideTarget& target, Free free);

}  // namespace bolt::force
