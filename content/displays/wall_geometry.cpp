#include "content/displays/wall_geometry.hpp"

#include <algorithm>
#include <limits>

namespace bolt::content {

namespace {

constexpr double min_sine = 1e-3;  // of the angle between walls that are not parallel

struct WallEdge {
    Vec3 from{0.0}, to{0.0};
};

std::array<WallEdge, 4> edges_of(const std::array<Vec3, 4>& corners) {
    std::array<WallEdge, 4> edges;
    for (std::size_t i = 0; i < 4; ++i) edges[i] = {corners[i], corners[(i + 1) % 4]};
    return edges;
}

// The part of the line from + t·along that is inside the wall, `margin` from its edges, as t; the line must
// lie in the wall's plane. Empty if first > second.
std::pair<double, double> inside(const WallAxes& wall, const Vec3& from, const Vec3& along, double margin) {
    std::pair range(-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
    for (const auto& [axis, size] : {std::pair(wall.right, wall.width), std::pair(wall.up, wall.height)}) {
        const double at = glm::dot(axis, from - wall.origin), slope = glm::dot(axis, along);
        if (std::abs(slope) < 1e-12) {
            if (at < margin || at > size - margin) return {1.0, 0.0};
            continue;
        }
        const auto [low, high] = std::minmax({(margin - at) / slope, (size - margin - at) / slope});
        range = {std::max(range.first, low), std::min(range.second, high)};
    }
    return range;
}

// The overlap of the projections of both outlines on `axis`; negative: the distance between them.
double overlap_along(const Vec3& axis, const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b) {
    const auto range = [&](const std::array<Vec3, 4>& corners) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Vec3& corner : corners) {
            low = std::min(low, glm::dot(axis, corner));
            high = std::max(high, glm::dot(axis, corner));
        }
        return std::pair(low, high);
    };
    const auto [a_low, a_high] = range(a);
    const auto [b_low, b_high] = range(b);
    return std::min(a_high, b_high) - std::max(a_low, b_low);
}

// The larger of the distances at both ends of the part where the edges run side by side; none if they do not.
std::optional<double> edge_gap(const WallEdge& a, const WallEdge& b) {
    constexpr double min_cosine = 0.9994;  // of 2°
    constexpr double min_share = 0.25;     // of the shorter edge
    const Vec3 along = a.to - a.from, other = b.to - b.from;
    const double length = glm::length(along), other_length = glm::length(other);
    const Vec3 direction = along / length;
    const double cosine = glm::dot(direction, other) / other_length;
    if (!(std::abs(cosine) >= min_cosine)) return std::nullopt;  // also for an edge of length 0
    const double start = glm::dot(direction, b.from - a.from), end = glm::dot(direction, b.to - a.from);
    const double low = std::max(0.0, std::min(start, end)), high = std::min(length, std::max(start, end));
    if (high - low < min_share * std::min(length, other_length)) return std::nullopt;
    const auto distance = [&](double at) {
        return glm::length(a.from + direction * at - (b.from + other * ((at - start) / (end - start))));
    };
    return std::max(distance(low), distance(high));
}

}  // namespace

WallAxes axes_of(const Wall& wall) {
    WallAxes axes;
    axes.origin = wall.lower_left;
    axes.width = width(wall);
    axes.height = height(wall);
    if (axes.width == 0.0 || axes.height == 0.0) return axes;
    axes.right = (wall.lower_right - wall.lower_left) / axes.width;
    axes.up = (wall.upper_right - wall.lower_right) / axes.height;
    const Vec3 normal = glm::cross(axes.right, axes.up);
    if (glm::length(normal) > 0.0) axes.normal = glm::normalize(normal);
    return axes;
}

std::array<Vec3, 4> corners_of(const WallAxes& wall, double margin) {
    const double right = wall.width - margin, top = wall.height - margin;
    return {in_room(wall, margin, margin), in_room(wall, right, margin), in_room(wall, right, top),
            in_room(wall, margin, top)};
}

bool walls_cross(const WallAxes& a, const WallAxes& b, double margin) {
    // The line that both planes have in common: its direction, and its point nearest to the origin of `a`.
    const Vec3 direction = glm::cross(a.normal, b.normal);
    const double sine = glm::length(direction);
    if (sine < min_sine) return false;
    const Vec3 along = direction / sine, towards_b = glm::cross(along, a.normal);
    const Vec3 from = a.origin - towards_b * (distance_in_front(b, a.origin) / glm::dot(towards_b, b.normal));
    const auto [a_first, a_last] = inside(a, from, along, margin);
    const auto [b_first, b_last] = inside(b, from, along, margin);
    return std::min(a_last, b_last) > std::max(a_first, b_first);
}

std::optional<double> edge_inset(const WallAxes& a, const WallAxes& b, double tolerance) {
    if (glm::length(glm::cross(a.normal, b.normal)) < min_sine) return std::nullopt;
    std::optional<double> deepest;
    for (const WallEdge& edge : edges_of(corners_of(a))) {
        if (std::abs(distance_in_front(b, edge.from)) > tolerance ||
            std::abs(distance_in_front(b, edge.to)) > tolerance)
            continue;
        const Vec3 along = edge.to - edge.from;
        const auto [first, last] = inside(b, edge.from, along, tolerance);
        const double from = std::max(first, 0.0), to = std::min(last, 1.0);
        if (from >= to) continue;
        const Vec3 at = edge.from + along * (0.5 * (from + to)) - b.origin;
        const double x = glm::dot(at, b.right), y = glm::dot(at, b.up);
        deepest = std::max(deepest.value_or(0.0), std::min({x, b.width - x, y, b.height - y}));
    }
    return deepest;
}

std::optional<double> coplanar_overlap(const WallAxes& a, const WallAxes& b, double tolerance) {
    const std::array<Vec3, 4> corners = corners_of(a), others = corners_of(b);
    for (const Vec3& corner : others)
        if (std::abs(distance_in_front(a, corner)) > tolerance) return std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& axis : {a.right, a.up, b.right, b.up})
        least = std::min(least, overlap_along(axis, corners, others));
    return least > tolerance ? std::optional(least) : std::nullopt;
}

std::optional<double> seam_gap(const WallAxes& a, const WallAxes& b) {
    std::optional<double> least;
    for (const WallEdge& one : edges_of(corners_of(a)))
        for (const WallEdge& other : edges_of(corners_of(b)))
            if (const auto gap = edge_gap(one, other))
                least = std::min(gap, std::optional(least.value_or(*gap)));
    return least;
}

}  // namespace bolt::content
