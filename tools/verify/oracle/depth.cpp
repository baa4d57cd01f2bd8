#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <vector>

#include "tools/author/geometry/crossing.hpp"
#include "tools/verify/oracle/surface.hpp"

namespace bolt::contact_oracle {

namespace {

using geometry::Bvh;
using geometry::Triangle;

constexpr double rounding = 1e-9;  // m

// Crossings of a surface by a ray on its way out, less those on its way in; none if an edge is too close to
// be sure.
std::optional<int> crossings(const Bvh& tree, const Vec3& from, const Vec3& along) {
    constexpr double sure = 1e-13;  // m²: an edge of 0.1 mm is passed at a nanometre
    const Vec3 inverse = 1.0 / along;
    int count = 0;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const Bvh::Node& node = tree.nodes()[stack.back()];
        stack.pop_back();
        const Vec3 half = node.half + 1e-8;
        const Vec3 a = (node.middle - half - from) * inverse, b = (node.middle + half - from) * inverse;
        const Vec3 in = glm::min(a, b), out = glm::max(a, b);
        if (std::min({out.x, out.y, out.z}) < std::max({in.x, in.y, in.z, 0.0})) continue;
        if (node.count == 0) {
            stack.push_back(node.first);
            stack.push_back(node.first + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = tree.triangles()[i];
            const Vec3 p = t.a - from, q = t.b - from, r = t.c - from;
            // On which side of the ray each edge passes; their sum is normal · ray.
            const double u = glm::dot(glm::cross(q, r), along), v = glm::dot(glm::cross(r, p), along),
                         w = glm::dot(glm::cross(p, q), along);
            const double least = std::min({u, v, w}), most = std::max({u, v, w});
            if (least < -sure && most > sure) continue;
            if (least <= sure && most >= -sure) return std::nullopt;
            const double way = glm::dot(geometry::normal_of(t), p) / (u + v + w);
            if (way > 0.0) count += most > 0.0 ? 1 : -1;
        }
    }
    return count;
}

// A piece of a triangle that may hold a deeper point than any known.
struct Cell {
    double most = 0.0;       // m, no point of it lies deeper
    std::uint32_t near = 0;  // a triangle of the surface that is near
    std::array<Vec3, 3> corners;
    friend bool operator<(const Cell& a, const Cell& b) { return a.most < b.most; }
};

class Search {
  public:
    Search(const Surface& other, const DepthOptions& depths)
        : other_(other), tolerance_(depths.tolerance), deepest_(depths.least), enough_(depths.enough) {}

    void add(const Triangle& t, const Pose& pose, std::uint32_t near) {
        add(std::array{pose * t.a, pose * t.b, pose * t.c}, near);
    }

    double run() {
        while (!done() && !cells_.empty() && cells_.top().most > deepest_ + tolerance_) {
            const std::array<Vec3, 3> t = cells_.top().corners;
            const std::uint32_t near = cells_.top().near;
            cells_.pop();
            std::array<Vec3, 3> half;
            for (std::size_t i = 0; i < 3; ++i) half[i] = 0.5 * (t[i] + t[(i + 1) % 3]);
            add({t[0], half[0], half[2]}, near);
            add({t[1], half[1], half[0]}, near);
            add({t[2], half[2], half[1]}, near);
            add(half, near);
        }
        return seen_;
    }

    [[nodiscard]] bool done() const { return seen_ > 0.0 && seen_ >= enough_; }

    // Whether a sphere is all outside, or not deep enough. `near`: a triangle of the surface that may be
    // middle; then how far it is from any point of it.
    [[nodiscard]] bool dull(const Vec3& middle, double radius, std::uint32_t& near) const {
        const NearestTriangle foot = nearest_to(middle, near);
        const double distance = foot.distance;
        near = foot.triangle;
        if (distance + radius <= deepest_ + tolerance_) return true;
        return radius - distance <= deepest_ + tolerance_ && winding(other_, middle) == 0;
    }

  private:
    // Whether the surface passes through a triangle.
    [[nodiscard]] bool meets(const std::array<Vec3, 3>& t) const {
        const Triangle own{t[0], t[1], t[2], 0};
        const Vec3 low = glm::min(glm::min(t[0], t[1]), t[2]), high = glm::max(glm::max(t[0], t[1]), t[2]);
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty()) {
            const Bvh::Node& node = other_.tree.nodes()[stack.back()];
            stack.pop_back();
            if (glm::any(glm::lessThan(node.middle + node.half, low)) ||
                glm::any(glm::greaterThan(node.middle - node.half, high)))
                continue;
            if (node.count == 0) {
                stack.push_back(node.first);
                stack.push_back(node.first + 1);
                continue;
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (geometry::cross(own, other_.tree.triangles()[i])) return true;
        }
        return false;
    }
    [[nodiscard]] NearestTriangle nearest_to(const Vec3& p, std::uint32_t near) const {
        return nearest(other_.tree, p, point_triangle(p, other_.tree.triangles()[near]) + rounding);
    }
    // `near`: a triangle of the other surface that may be the nearest.
    void add(const std::array<Vec3, 3>& t, std::uint32_t near) {
        const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
        double radius = 0.0;
        for (const Vec3& p : t) radius = std::max(radius, glm::length(p - middle));
        const NearestTriangle foot = nearest_to(middle, near);
        if (foot.distance + radius <= deepest_ + tolerance_) return;
        const bool inside = winding(other_, middle) != 0;
        // From outside the way inward begins at the surface.
        double most = inside ? foot.distance + radius : radius - foot.distance;
        if (inside) seen_ = std::max(seen_, foot.distance);
        deepest_ = std::max(deepest_, seen_);
        if (most <= deepest_ + tolerance_ || (!inside && !meets(t))) return;
        // The distance from one triangle is convex, so nowhere in the cell greater than at its corners, and
        // what is inside is no deeper than that.
        double at_corners = 0.0;
        for (const Vec3& p : t)
            at_corners = std::max(at_corners, point_triangle(p, other_.tree.triangles()[foot.triangle]));
        most = std::min(most, at_corners);
        if (most > deepest_ + tolerance_ && radius > 0.0) cells_.push({most, foot.triangle, t});
    }

    const Surface& other_;
    double tolerance_, deepest_, enough_;
    double seen_ = 0.0;
    std::priority_queue<Cell> cells_;
};

}  // namespace

int winding_by_solid_angle(const Bvh& tree, const Vec3& point) {
    double sum = 0.0;
    for (const Triangle& t : tree.triangles()) {
        const Vec3 a = t.a - point, b = t.b - point, c = t.c - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                   glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return static_cast<int>(std::lround(sum / (4.0 * pi)));
}

int winding(const Surface& surface, const Vec3& point) {
    if (surface.tree.nodes().empty()) return 0;
    const geometry::Box box = surface.tree.box();
    if (glm::any(glm::lessThan(point, box.low)) || glm::any(glm::greaterThan(point, box.high))) return 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 along =
            glm::normalize(Vec3(std::cos(1.0 + 2.4 * i), std::sin(1.0 + 2.4 * i), 0.31 * i - 1.07));
        if (const std::optional<int> count = crossings(surface.tree, point, along)) return *count;
    }
    return winding_by_solid_angle(surface.tree, point);
}

double depth_in(const Bvh& mine, const Surface& other, const Pose& mine_to_other,
                const DepthOptions& depths) {
    if (mine.nodes().empty() || other.tree.nodes().empty()) return 0.0;
    Search search(other, depths);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty() && !search.done()) {
        auto [index, near] = stack.back();
        stack.pop_back();
        const Bvh::Node& node = mine.nodes()[index];
        if (search.dull(mine_to_other * node.middle, glm::length(node.half), near)) continue;
        if (node.count == 0) {
            stack.emplace_back(node.first, near);
            stack.emplace_back(node.first + 1, near);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            search.add(mine.triangles()[i], mine_to_other, near);
    }
    return search.run();
}

}  // namespace bolt::contact_oracle
