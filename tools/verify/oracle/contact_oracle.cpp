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

ClosedSurface make_surface(std::vector<geometry::Triangle> triangles) {
    return {geometry::Bvh(std::move(triangles))};
}

double signed_distance(const ClosedSurface& surface, const Vec3& point, double reach) {
    const double distance = nearest(surface.tree, point, reach).distance;
    return winding(surface, point) != 0 ? -distance : distance;
}

double depth(const ClosedSurface& a, const ClosedSurface& b, const Pose& b_to_a,
             const DepthOptions& options) {
    if (!cross(a.tree, b.tree, b_to_a)) return 0.0;
    const double first = depth_in(b.tree, a, b_to_a, options);
    DepthOptions rest = options;
    rest.min_depth = std::max(options.min_depth, first);
    return std::max(first, depth_in(a.tree, b, inverse(b_to_a), rest));
}

namespace {

using geometry::Bvh;
using geometry::Triangle;

double point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double square = glm::dot(along, along);
    const double s = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return glm::length(p - (a + s * along));
}

// Returns the length of the common perpendicular of segments ab and cd if it meets both, else infinity. Two
// segments are nearest either there or at an end of one.
double perpendicular_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const Vec3 u = b - a, v = d - c, n = glm::cross(u, v), between = c - a;
    const double nn = glm::dot(n, n);
    if (!(nn > 1e-20 * glm::dot(u, u) * glm::dot(v, v))) return none;
    const double s = glm::dot(glm::cross(between, v), n) / nn;
    const double t = glm::dot(glm::cross(between, u), n) / nn;
    if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return none;
    return std::abs(glm::dot(between, n)) / std::sqrt(nn);
}

// A pose as a matrix, which is faster than a quaternion for many points. `abs_turn` has the absolute values
// of `turn`: it maps the half size of a box to that of the box around the rotated box.
struct RigidTransform {
    glm::dmat3 turn, abs_turn;
    Vec3 shift;
    explicit RigidTransform(const Pose& pose) : turn(glm::mat3_cast(pose.orientation)), shift(pose.position) {
        for (int i = 0; i < 3; ++i) abs_turn[i] = glm::abs(turn[i]);
    }
    Vec3 operator()(const Vec3& p) const { return turn * p + shift; }
    Triangle operator()(const Triangle& t) const {
        return {(*this)(t.a), (*this)(t.b), (*this)(t.c), t.part};
    }
    Bvh::Node operator()(const Bvh::Node& n) const {
        return {(*this)(n.middle), abs_turn * n.half, n.first, n.count};
    }
};

double box_distance(const Bvh::Node& a, const Bvh::Node& b) {
    return glm::length(glm::max(glm::abs(a.middle - b.middle) - a.half - b.half, Vec3(0.0)));
}
Bvh::Node box_of(const Triangle& t) {
    const Vec3 low = glm::min(glm::min(t.a, t.b), t.c), high = glm::max(glm::max(t.a, t.b), t.c);
    return {0.5 * (low + high), 0.5 * (high - low), 0, 1};
}
double radius_of(const Bvh::Node& node) { return glm::length(node.half); }

// Calls visit(s, t, reach) for pairs of triangles nearer than `reach` (m). `visit` may reduce `reach`; a
// negative value ends the traversal.
template <class Visit>
void visit_close_pairs(const Bvh& a, const Bvh& b, const Pose& b_to_a, double reach, const Visit& visit) {
    if (a.nodes().empty() || b.nodes().empty()) return;
    const RigidTransform to_a(b_to_a);
    struct NodePair {
        std::uint32_t i, k;
        double least;
    };
    std::vector<NodePair> stack{{0, 0, 0.0}};
    std::vector<Triangle> placed;
    while (!stack.empty()) {
        const NodePair pair = stack.back();
        stack.pop_back();
        if (pair.least > reach) continue;
        const Bvh::Node& x = a.nodes()[pair.i];
        const Bvh::Node& y = b.nodes()[pair.k];
        if (x.count > 0 && y.count > 0) {
            placed.clear();
            for (std::uint32_t k = y.first; k < y.first + y.count; ++k)
                placed.push_back(to_a(b.triangles()[k]));
            for (std::uint32_t i = x.first; i < x.first + x.count; ++i)
                for (const Triangle& t : placed) {
                    const Triangle& s = a.triangles()[i];
                    if (box_distance(box_of(s), box_of(t)) <= reach) visit(s, t, reach);
                    if (reach < 0.0) return;
                }
            continue;
        }
        const bool open_x = y.count > 0 || (x.count == 0 && radius_of(x) >= radius_of(y));
        NodePair first = pair, second = pair;
        if (open_x) {
            first.i = x.first;
            second.i = x.first + 1;
        } else {
            first.k = y.first;
            second.k = y.first + 1;
        }
        for (NodePair* p : {&first, &second}) p->least = box_distance(a.nodes()[p->i], to_a(b.nodes()[p->k]));
        if (first.least < second.least) std::swap(first, second);  // the nearer pair on top
        for (const NodePair& p : {first, second})
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
    return std::min({point_segment_distance(p, t.a, t.b), point_segment_distance(p, t.b, t.c),
                     point_segment_distance(p, t.c, t.a)});
}

double triangle_triangle(const Triangle& s, const Triangle& t) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : {s.a, s.b, s.c}) least = std::min(least, point_triangle(p, t));
    for (const Vec3& p : {t.a, t.b, t.c}) least = std::min(least, point_triangle(p, s));
    for (const auto& [a, b] : {std::pair(s.a, s.b), std::pair(s.b, s.c), std::pair(s.c, s.a)})
        for (const auto& [c, d] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
            least = std::min(least, perpendicular_distance(a, b, c, d));
    return least;
}

NearestTriangle nearest(const Bvh& tree, const Vec3& point, double reach) {
    NearestTriangle closest{std::numeric_limits<double>::infinity(), 0};
    if (tree.nodes().empty()) return closest;
    const auto distance_to = [&](std::uint32_t node) {
        const Bvh::Node& n = tree.nodes()[node];
        return glm::length(glm::max(glm::abs(n.middle - point) - n.half, Vec3(0.0)));
    };
    std::vector<std::pair<double, std::uint32_t>> stack{{distance_to(0), 0}};
    while (!stack.empty()) {
        const auto [least, index] = stack.back();
        stack.pop_back();
        if (least > reach) continue;
        const Bvh::Node& node = tree.nodes()[index];
        if (node.count == 0) {
            std::pair a(distance_to(node.first), node.first), b(distance_to(node.first + 1), node.first + 1);
            if (a.first < b.first) std::swap(a, b);
            stack.push_back(a);
            stack.push_back(b);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const double d = point_triangle(point, tree.triangles()[i]);
            if (d <= reach && d < closest.distance) {
                closest = {d, i};
                reach = d;
            }
        }
    }
    return closest;
}

bool cross(const Bvh& a, const Bvh& b, const Pose& b_to_a) {
    bool crossed = false;
    visit_close_pairs(a, b, b_to_a, 0.0, [&](const Triangle& s, const Triangle& t, double& reach) {
        if (!geometry::triangles_cross(s, t)) return;
        crossed = true;
        reach = -1.0;
    });
    return crossed;
}

double gap(const Bvh& a, const Bvh& b, const Pose& b_to_a, double reach) {
    double least = reach;
    visit_close_pairs(a, b, b_to_a, reach, [&](const Triangle& s, const Triangle& t, double& within) {
        within = least = std::min(least, triangle_triangle(s, t));
    });
    return least;
}

namespace {

constexpr double rounding = 1e-9;  // m

// Returns the number of times that a ray leaves the surface minus the number of times that it enters; nothing
// if the ray passes too close to an edge to decide.
std::optional<int> signed_crossings(const Bvh& tree, const Vec3& from, const Vec3& along) {
    constexpr double min_area = 1e-13;  // m²: for an edge of 0.1 mm, a distance of 1 nm from the ray
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
            // The sign gives the side on which the ray passes each edge; the sum is normal · ray.
            const double u = glm::dot(glm::cross(q, r), along), v = glm::dot(glm::cross(r, p), along),
                         w = glm::dot(glm::cross(p, q), along);
            const double least = std::min({u, v, w}), most = std::max({u, v, w});
            if (least < -min_area && most > min_area) continue;
            if (least <= min_area && most >= -min_area) return std::nullopt;
            const double t_ray = glm::dot(geometry::normal_of(t), p) / (u + v + w);
            if (t_ray > 0.0) count += most > 0.0 ? 1 : -1;
        }
    }
    return count;
}

// A part of a triangle that may contain a point deeper than the deepest found so far.
struct Cell {
    double most = 0.0;       // m, upper bound of the depth of its points
    std::uint32_t near = 0;  // index of a nearby triangle of the other surface
    std::array<Vec3, 3> corners;
    friend bool operator<(const Cell& a, const Cell& b) { return a.most < b.most; }
};

// Branch-and-bound search for the deepest point of added triangles in the surface `other`.
class DepthSearch {
  public:
    DepthSearch(const ClosedSurface& other, const DepthOptions& options)
        : other_(other),
          tolerance_(options.tolerance),
          deepest_(options.min_depth),
          stop_depth_(options.stop_depth) {}

    void add_triangle(const Triangle& t, const Pose& pose, std::uint32_t near) {
        add_cell(std::array{pose * t.a, pose * t.b, pose * t.c}, near);
    }

    double run() {
        while (!done() && !cells_.empty() && cells_.top().most > deepest_ + tolerance_) {
            const std::array<Vec3, 3> t = cells_.top().corners;
            const std::uint32_t near = cells_.top().near;
            cells_.pop();
            std::array<Vec3, 3> half;
            for (std::size_t i = 0; i < 3; ++i) half[i] = 0.5 * (t[i] + t[(i + 1) % 3]);
            add_cell({t[0], half[0], half[2]}, near);
            add_cell({t[1], half[1], half[0]}, near);
            add_cell({t[2], half[2], half[1]}, near);
            add_cell(half, near);
        }
        return found_depth_;
    }

    [[nodiscard]] bool done() const { return found_depth_ > 0.0 && found_depth_ >= stop_depth_; }

    // Returns whether no point of a sphere can be deeper than the deepest found so far. `near` is a guess of
    // the triangle nearest to `middle` on entry, and that triangle on return.
    [[nodiscard]] bool cannot_be_deeper(const Vec3& middle, double radius, std::uint32_t& near) const {
        const NearestTriangle closest = nearest_to(middle, near);
        const double distance = closest.distance;
        near = closest.triangle;
        if (distance + radius <= deepest_ + tolerance_) return true;
        return radius - distance <= deepest_ + tolerance_ && winding(other_, middle) == 0;
    }

  private:
    // Returns whether the other surface passes through triangle `t`.
    [[nodiscard]] bool meets_other(const std::array<Vec3, 3>& t) const {
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
                if (geometry::triangles_cross(own, other_.tree.triangles()[i])) return true;
        }
        return false;
    }
    [[nodiscard]] NearestTriangle nearest_to(const Vec3& p, std::uint32_t near) const {
        return nearest(other_.tree, p, point_triangle(p, other_.tree.triangles()[near]) + rounding);
    }
    // `near`: a guess of the nearest triangle of the other surface.
    void add_cell(const std::array<Vec3, 3>& t, std::uint32_t near) {
        const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
        double radius = 0.0;
        for (const Vec3& p : t) radius = std::max(radius, glm::length(p - middle));
        const NearestTriangle closest = nearest_to(middle, near);
        if (closest.distance + radius <= deepest_ + tolerance_) return;
        const bool inside = winding(other_, middle) != 0;
        // A point outside by d can reach a depth of at most radius − d within the sphere.
        double most = inside ? closest.distance + radius : radius - closest.distance;
        if (inside) found_depth_ = std::max(found_depth_, closest.distance);
        deepest_ = std::max(deepest_, found_depth_);
        if (most <= deepest_ + tolerance_ || (!inside && !meets_other(t))) return;
        // The distance to one triangle is convex, so its maximum over the cell is at a corner. It bounds the
        // depth of the points inside.
        double at_corners = 0.0;
        for (const Vec3& p : t)
            at_corners = std::max(at_corners, point_triangle(p, other_.tree.triangles()[closest.triangle]));
        most = std::min(most, at_corners);
        if (most > deepest_ + tolerance_ && radius > 0.0) cells_.push({most, closest.triangle, t});
    }

    const ClosedSurface& other_;
    double tolerance_, deepest_, stop_depth_;
    double found_depth_ = 0.0;
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

int winding(const ClosedSurface& surface, const Vec3& point) {
    if (surface.tree.nodes().empty()) return 0;
    const geometry::Aabb box = surface.tree.box();
    if (glm::any(glm::lessThan(point, box.low)) || glm::any(glm::greaterThan(point, box.high))) return 0;
    for (int i = 0; i < 8; ++i) {
        const Vec3 along =
            glm::normalize(Vec3(std::cos(1.0 + 2.4 * i), std::sin(1.0 + 2.4 * i), 0.31 * i - 1.07));
        if (const std::optional<int> count = signed_crossings(surface.tree, point, along)) return *count;
    }
    return winding_by_solid_angle(surface.tree, point);
}

double depth_in(const Bvh& mine, const ClosedSurface& other, const Pose& mine_to_other,
                const DepthOptions& options) {
    if (mine.nodes().empty() || other.tree.nodes().empty()) return 0.0;
    DepthSearch search(other, options);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty() && !search.done()) {
        auto [index, near] = stack.back();
        stack.pop_back();
        const Bvh::Node& node = mine.nodes()[index];
        if (search.cannot_be_deeper(mine_to_other * node.middle, glm::length(node.half), near)) continue;
        if (node.count == 0) {
            stack.emplace_back(node.first, near);
            stack.emplace_back(node.first + 1, near);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
            search.add_triangle(mine.triangles()[i], mine_to_other, near);
    }
    return search.run();
}

}  // namespace bolt::contact_oracle
