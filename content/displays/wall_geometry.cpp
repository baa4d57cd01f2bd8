#include "content/displays/wall_geometry.hpp"

#include <algorithm>
#include <limits>

namespace bolt::content {

namespace {

struct WallEdge {
    Vec3 from{0.0}, to{0.0};
};

std::array<WallEdge, 4> edges_of(const std::array<Vec3, 4>& corners) {
    std::array<WallEdge, 4> edges;
    for (std::size_t i = 0; i < 4; ++i) edges[i] = {corners[i], corners[(i + 1) % 4]};
    return edges;
}

// Returns true if the edge passes through the wall, `margin` inside its edges.
bool pierces(const WallEdge& edge, const WallFrame& wall, double margin) {
    const double from = distance_in_front(wall, edge.from), to = distance_in_front(wall, edge.to);
    if (from * to >= 0.0) return false;
    const Vec3 at = edge.from + (edge.to - edge.from) * (from / (from - to)) - wall.origin;
    const double x = glm::dot(at, wall.right), y = glm::dot(at, wall.up);
    return x > margin && x < wall.width - margin && y > margin && y < wall.height - margin;
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
    constexpr double least_cosine = 0.9994;  // of 2°
    constexpr double least_share = 0.25;     // of the shorter edge
    const Vec3 along = a.to - a.from, other = b.to - b.from;
    const double length = glm::length(along), other_length = glm::length(other);
    const Vec3 direction = along / length;
    const double cosine = glm::dot(direction, other) / other_length;
    if (std::abs(cosine) < least_cosine) return std::nullopt;
    const double start = glm::dot(direction, b.from - a.from), end = glm::dot(direction, b.to - a.from);
    const double low = std::max(0.0, std::min(start, end)), high = std::min(length, std::max(start, end));
    if (high - low < least_share * std::min(length, other_length)) return std::nullopt;
    const auto distance = [&](double at) {
        return glm::length(a.from + direction * at - (b.from + other * ((at - start) / (end - start))));
    };
    return std::max(distance(low), distance(high));
}

}  // namespace

WallFrame frame_of(const Wall& wall) {
    WallFrame frame;
    frame.origin = wall.lower_left;
    frame.width = width(wall);
    frame.height = height(wall);
    if (frame.width == 0.0 || frame.height == 0.0) return frame;
    frame.right = (wall.lower_right - wall.lower_left) / frame.width;
    frame.up = (wall.upper_right - wall.lower_right) / frame.height;
    const Vec3 normal = glm::cross(frame.right, frame.up);
    if (glm::length(normal) > 0.0) frame.normal = glm::normalize(normal);
    return frame;
}

std::array<Vec3, 4> corners_of(const WallFrame& wall, double margin) {
    const double right = wall.width - margin, top = wall.height - margin;
    return {in_room(wall, margin, margin), in_room(wall, right, margin), in_room(wall, right, top),
            in_room(wall, margin, top)};
}

bool cross(const WallFrame& a, const WallFrame& b, double margin) {
    const auto any = [margin](const WallFrame& edges, const WallFrame& wall) {
        const auto all = edges_of(corners_of(edges, margin));
        return std::any_of(all.begin(), all.end(),
                           [&](const WallEdge& edge) { return pierces(edge, wall, margin); });
    };
    return any(a, b) || any(b, a);
}

std::optional<double> coplanar_overlap(const WallFrame& a, const WallFrame& b, double tolerance) {
    const std::array<Vec3, 4> corners = corners_of(a), others = corners_of(b);
    for (const Vec3& corner : others)
        if (std::abs(distance_in_front(a, corner)) > tolerance) return std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& axis : {a.right, a.up, b.right, b.up})
        least = std::min(least, overlap_along(axis, corners, others));
    return least > tolerance ? std::optional(least) : std::nullopt;
}

std::optional<double> seam_gap(const WallFrame& a, const WallFrame& b) {
    std::optional<double> least;
    for (const WallEdge& one : edges_of(corners_of(a)))
        for (const WallEdge& other : edges_of(corners_of(b)))
            if (const auto gap = edge_gap(one, other))
                least = std::min(gap, std::optional(least.value_or(*gap)));
    return least;
}

}  // namespace bolt::content
