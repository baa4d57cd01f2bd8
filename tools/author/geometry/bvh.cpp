#include "tools/author/geometry/bvh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bolt::geometry {

namespace {

constexpr std::uint32_t leaf_size = 4;

Vec3 centroid(const Triangle& t) { return (t.a + t.b + t.c) / 3.0; }

// Returns the distance at which the ray enters the box; infinity if it misses.
double entry_distance(const Bvh::Node& node, const Vec3& origin, const Vec3& inverse) {
    const Vec3 near = (node.middle - node.half - origin) * inverse;
    const Vec3 far = (node.middle + node.half - origin) * inverse;
    double in = 0.0, out = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        // A ray in the plane of a face gives 0 · ∞ = NaN, which fmin and fmax ignore.
        in = std::fmax(in, std::fmin(near[i], far[i]));
        out = std::fmin(out, std::fmax(near[i], far[i]));
    }
    return in <= out ? in : std::numeric_limits<double>::infinity();
}

// Distance along the ray to the triangle, infinity without a hit. T. Möller, B. Trumbore: Fast, minimum
// storage ray–triangle intersection (1997).
double hit_distance(const Triangle& t, const Vec3& origin, const Vec3& direction) {
    constexpr double none = std::numeric_limits<double>::infinity();
    const Vec3 e1 = t.b - t.a, e2 = t.c - t.a, p = glm::cross(direction, e2);
    const double det = glm::dot(e1, p);
    if (det == 0.0) return none;
    const Vec3 s = origin - t.a;
    const double u = glm::dot(s, p) / det;
    const Vec3 q = glm::cross(s, e1);
    const double v = glm::dot(direction, q) / det;
    if (!(u >= 0.0) || !(v >= 0.0) || !(u + v <= 1.0)) return none;
    const double distance = glm::dot(e2, q) / det;
    return distance >= 0.0 ? distance : none;
}

}  // namespace

Bvh::Bvh(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
    if (triangles_.empty()) return;
    nodes_.reserve(triangles_.size());
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(triangles_.size()));
}

Aabb Bvh::box() const {
    if (nodes_.empty()) return {};
    return {nodes_[0].middle - nodes_[0].half, nodes_[0].middle + nodes_[0].half};
}

void Bvh::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    Aabb box, centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        const Triangle& t = triangles_[i];
        for (const Vec3& p : {t.a, t.b, t.c}) box.add(p);
        centres.add(centroid(t));
    }
    nodes_[node].middle = box.middle();
    nodes_[node].half = box.half();
    if (count <= leaf_size) {
        nodes_[node].first = first;
        nodes_[node].count = count;
        return;
    }
    const Vec3 size = centres.half();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t half = count / 2;
    const auto begin = triangles_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [axis](const Triangle& a, const Triangle& b) {
        return centroid(a)[axis] < centroid(b)[axis];
    });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[node].first = child;
    nodes_.resize(nodes_.size() + 2);
    split(child, first, half);
    split(child + 1, first + half, count - half);
}

std::optional<RayHit> first_hit(const Bvh& bvh, const Vec3& origin, const Vec3& direction, double reach,
                                const SkipPart& skip) {
    std::optional<RayHit> best;
    if (bvh.nodes().empty()) return best;
    const Vec3 inverse = 1.0 / direction;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const Bvh::Node& node = bvh.nodes()[stack.back()];
        stack.pop_back();
        if (entry_distance(node, origin, inverse) > reach) continue;
        if (node.count == 0) {
            stack.push_back(node.first);
            stack.push_back(node.first + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = bvh.triangles()[i];
            const double distance = hit_distance(t, origin, direction);
            if (distance > reach || (best && distance >= best->distance) || (skip && skip(t.part))) continue;
            best = RayHit{distance, i};
            reach = distance;
        }
    }
    return best;
}

namespace {

// Six times the signed volume of a tetrahedron.
double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return glm::dot(glm::cross(b - a, c - a), d - a);
}

bool segment_crosses(const Vec3& p, const Vec3& q, const Triangle& t) {
    const double above = volume(t.a, t.b, t.c, p), below = volume(t.a, t.b, t.c, q);
    if (!(above * below < 0.0)) return false;
    const double u = volume(p, q, t.a, t.b), v = volume(p, q, t.b, t.c), w = volume(p, q, t.c, t.a);
    return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

// Returns true if `t` lies on one side of the plane of `s` or in the plane.
bool on_one_side(const Triangle& s, const Triangle& t) {
    const Vec3 n = normal_of(s);
    const double a = glm::dot(n, t.a - s.a), b = glm::dot(n, t.b - s.a), c = glm::dot(n, t.c - s.a);
    return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

// Separating-axis test of an axis-aligned box and a box rotated about Y.
bool separated(const Bvh::Node& still, const Bvh::Node& moving, const TurnAboutY& pose) {
    const Vec3 d = pose(moving.middle) - still.middle;
    const double c = std::abs(pose.cosine), s = std::abs(pose.sine);
    const Vec3 &a = still.half, &b = moving.half;
    return std::abs(d.y) > a.y + b.y || std::abs(d.x) > a.x + b.x * c + b.z * s ||
           std::abs(d.z) > a.z + b.x * s + b.z * c ||
           std::abs(d.x * pose.cosine - d.z * pose.sine) > b.x + a.x * c + a.z * s ||
           std::abs(d.x * pose.sine + d.z * pose.cosine) > b.z + a.x * s + a.z * c;
}

double size_of(const Bvh::Node& node) { return node.half.x + node.half.y + node.half.z; }

}  // namespace

bool triangles_cross(const Triangle& s, const Triangle& t) {
    if (on_one_side(s, t) || on_one_side(t, s)) return false;
    return segment_crosses(s.a, s.b, t) || segment_crosses(s.b, s.c, t) || segment_crosses(s.c, s.a, t) ||
           segment_crosses(t.a, t.b, s) || segment_crosses(t.b, t.c, s) || segment_crosses(t.c, t.a, s);
}

std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const TurnAboutY& pose,
                                            const SkipPart& skip) {
    if (still.nodes().empty() || moving.nodes().empty()) return std::nullopt;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [i, k] = stack.back();
        stack.pop_back();
        const Bvh::Node &a = still.nodes()[i], &b = moving.nodes()[k];
        if (separated(a, b, pose)) continue;
        if (a.count == 0 && (b.count > 0 || size_of(a) >= size_of(b))) {
            stack.emplace_back(a.first, k);
            stack.emplace_back(a.first + 1, k);
            continue;
        }
        if (b.count == 0) {
            stack.emplace_back(i, b.first);
            stack.emplace_back(i, b.first + 1);
            continue;
        }
        for (std::uint32_t m = b.first; m < b.first + b.count; ++m) {
            const Triangle& own = moving.triangles()[m];
            const Triangle posed{pose(own.a), pose(own.b), pose(own.c), own.part};
            for (std::uint32_t n = a.first; n < a.first + a.count; ++n)
                if (triangles_cross(posed, still.triangles()[n]) &&
                    !(skip && skip(still.triangles()[n].part)))
                    return n;
        }
    }
    return std::nullopt;
}

}  // namespace bolt::geometry
