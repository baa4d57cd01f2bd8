#include "haptics/force/guide_path.hpp"

#include <algorithm>
#include <initializer_list>

namespace bolt::force {

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
    return offset.above < 0.5 * target.shell || offset.aside <= on_axis + cone * offset.above;
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
    if (aside >= target.shell) return free(from, to);
    // Query only the parts of the segment before and behind the ball around the target.
    const double half = std::sqrt(square(target.shell) - square(aside));
    const double in = nearest - half, out = nearest + half;
    if (in >= distance || out <= 0.0) return free(from, to);
    return (in <= 0.0 || free(from, from + in * direction)) &&
           (out >= distance || free(from + out * direction, to));
}

GuidePath plan_path(const Vec3& from, const GuideTarget& target, IsSegmentFree free) {
    const Vec3 above = target.point + target.axis * target.approach;
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

double lowest_ahead(const GuideTarget& target, const Vec3& tool) {
    const AxialOffset offset = axial_offset(target, tool);
    return std::clamp(std::min((offset.aside - on_axis) / cone, offset.above), 0.0, target.approach);
}

void move_end(GuidePath& path, const GuideTarget& target) {
    if (path.count == 0) return;
    path.points[path.count - 1] = target.point;
    if (path.count > 2) path.points[path.count - 2] = target.point + target.axis * target.approach;
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

}  // namespace bolt::force
