#include "tools/verify/oracle/contact_oracle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "tools/author/geometry/bvh.hpp"

namespace bolt::contact_oracle {

Surface make_surface(std::vector<geometry::Triangle> triangles) {
    return {geometry::Bvh(std::move(triangles))};
}

double signed_distance(const Surface& surface, const Vec3& point, double reach) {
    const double distance = nearest(surface.tree, point, reach).distance;
    return winding(surface, point) != 0 ? -distance : distance;
}

double depth(const Surface& a, const Surface& b, const Pose& b_to_a, const DepthOptions& options) {
    if (!cross(a.tree, b.tree, b_to_a)) return 0.0;
    const double first = depth_in(b.tree, a, b_to_a, options);
    DepthOptions rest = options;
    rest.least = std::max(options.least, first);
    return std::max(first, depth_in(a.tree, b, inverse(b_to_a), rest));
}

namespace {

using geometry::Bvh;
using geometry::Triangle;

double point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double square = glm::dot(along, along);
    const double s = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return glm::length(p - (a + s * along));
}

// Two segments are nearest at an end of one, or where the common perpendicular stands on both.
double perpendicular(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const Vec3 u = b - a, v = d - c, n = glm::cross(u, v), between = c - a;
    const double nn = glm::dot(n, n);
    if (!(nn > 1e-20 * glm::dot(u, u) * glm::dot(v, v))) return none;
    const double s = glm::dot(glm::cross(between, v), n) / nn;
    const double t = glm::dot(glm::cross(between, u), n) / nn;
    if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return none;
    return std::abs(glm::dot(between, n)) / std::sqrt(nn);
}

// A pose as a matrix, which is quicker for many points.
struct Placing {
    glm::dmat3 turn, size;
    Vec3 shift;
    explicit Placing(const Pose& pose) : turn(glm::mat3_cast(pose.orientation)), shift(pose.position) {
        for (int i = 0; i < 3; ++i) size[i] = glm::abs(turn[i]);
    }
    Vec3 operator()(const Vec3& p) const { return turn * p + shift; }
    Triangle operator()(const Triangle& t) const {
        return {(*this)(t.a), (*this)(t.b), (*this)(t.c), t.part};
    }
    Bvh::Node operator()(const Bvh::Node& n) const {
        return {(*this)(n.middle), size * n.half, n.first, n.count};
    }
};

double between_boxes(const Bvh::Node& a, const Bvh::Node& b) {
    return glm::length(glm::max(glm::abs(a.middle - b.middle) - a.half - b.half, Vec3(0.0)));
}
Bvh::Node box_of(const Triangle& t) {
    const Vec3 low = glm::min(glm::min(t.a, t.b), t.c), high = glm::max(glm::max(t.a, t.b), t.c);
    return {0.5 * (low + high), 0.5 * (high - low), 0, 1};
}
double size_of(const Bvh::Node& node) { return glm::length(node.half); }

// Visits pairs of triangles nearer than `reach`, which `look` may shorten; it ends when that is below 0.
template <class Look>
void pairs(const Bvh& a, const Bvh& b, const Pose& b_to_a, double reach, const Look& look) {
    if (a.nodes().empty() || b.nodes().empty()) return;
    const Placing place(b_to_a);
    struct Pair {
        std::uint32_t i, k;
        double least;
    };
    std::vector<Pair> stack{{0, 0, 0.0}};
    std::vector<Triangle> placed;
    while (!stack.empty()) {
        const Pair pair = stack.back();
        stack.pop_back();
        if (pair.least > reach) continue;
        const Bvh::Node& x = a.nodes()[pair.i];
        const Bvh::Node& y = b.nodes()[pair.k];
        if (x.count > 0 && y.count > 0) {
            placed.clear();
            for (std::uint32_t k = y.first; k < y.first + y.count; ++k)
                placed.push_back(place(b.triangles()[k]));
            for (std::uint32_t i = x.first; i < x.first + x.count; ++i)
                for (const Triangle& t : placed) {
                    const Triangle& s = a.triangles()[i];
                    if (between_boxes(box_of(s), box_of(t)) <= reach) look(s, t, reach);
                    if (reach < 0.0) return;
                }
            continue;
        }
        const bool open_x = y.count > 0 || (x.count == 0 && size_of(x) >= size_of(y));
        Pair first = pair, second = pair;
        if (open_x) {
            first.i = x.first;
            second.i = x.first + 1;
        } else {
            first.k = y.first;
            second.k = y.first + 1;
        }
        for (Pair* p : {&first, &second}) p->least = between_boxes(a.nodes()[p->i], place(b.nodes()[p->k]));
        if (first.least < second.least) std::swap(first, second);  // the nearer on top
        for (const Pair& p : {first, second})
            if (p.least <= reach) stack.push_back(p);
    }
}

}  // namespace

double point_triangle(const Vec3& p, const Triangle& t) {
    const Vec3 n = geometry::normal_of(t);
    const double square = glm::dot(n, n);
    if (square > 0.0 && glm::dot(glm::cross(t.b - t.a, p - t.a), n) >= 0.0 &&
        glm::dot(glm::cross(t.c - t.b, p - t.b), n) >= 0.0 &&
        glm::dot(glm::cross(t.a - t.c, p - t.c), n) >= 0.0)
        return std::abs(glm::dot(p - t.a, n)) / std::sqrt(square);
    return std::min({point_segment(p, t.a, t.b), point_segment(p, t.b, t.c), point_segment(p, t.c, t.a)});
}

double triangle_triangle(const Triangle& s, const Triangle& t) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : {s.a, s.b, s.c}) least = std::min(least, point_triangle(p, t));
    for (const Vec3& p : {t.a, t.b, t.c}) least = std::min(least, point_triangle(p, s));
    for (const auto& [a, b] : {std::pair(s.a, s.b), std::pair(s.b, s.c), std::pair(s.c, s.a)})
        for (const auto& [c, d] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
            least = std::min(least, perpendicular(a, b, c, d));
    return least;
}

NearestTriangle nearest(const Bvh& tree, const Vec3& point, double reach) {
    NearestTriangle foot{std::numeric_limits<double>::infinity(), 0};
    if (tree.nodes().empty()) return foot;
    const auto to = [&](std::uint32_t node) {
        const Bvh::Node& n = tree.nodes()[node];
        return glm::length(glm::max(glm::abs(n.middle - point) - n.half, Vec3(0.0)));
    };
    std::vector<std::pair<double, std::uint32_t>> stack{{to(0), 0}};
    while (!stack.empty()) {
        const auto [least, index] = stack.back();
        stack.pop_back();
        if (least > reach) continue;
        const Bvh::Node& node = tree.nodes()[index];
        if (node.count == 0) {
            std::pair a(to(node.first), node.first), b(to(node.first + 1), node.first + 1);
            if (a.first < b.first) std::swap(a, b);
            stack.push_back(a);
            stack.push_back(b);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const double d = point_triangle(point, tree.triangles()[i]);
            if (d <= reach && d < foot.distance) {
                foot = {d, i};
                reach = d;
            }
        }
    }
    return foot;
}

bool cross(const Bvh& a, const Bvh& b, const Pose& b_to_a) {
    bool crossed = false;
    pairs(a, b, b_to_a, 0.0, [&](const Triangle& s, const Triangle& t, double& reach) {
        if (!geometry::cross(s, t)) return;
        crossed = true;
        reach = -1.0;
    });
    return crossed;
}

double gap(const Bvh& a, const Bvh& b, const Pose& b_to_a, double reach) {
    double least = reach;
    pairs(a, b, b_to_a, reach, [&](const Triangle& s, const Triangle& t, double& within) {
        within = least = std::min(least, triangle_triangle(s, t));
    });
    return least;
}

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
