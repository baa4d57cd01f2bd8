#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "tools/author/geometry/crossing.hpp"
#include "tools/verify/oracle/surface.hpp"

namespace bolt::contact_oracle {

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

}  // namespace bolt::contact_oracle
