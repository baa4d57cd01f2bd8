#include "tools/author/geometry/bvh.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::geometry {

namespace {

constexpr std::uint32_t leaf_size = 4;

Vec3 centroid(const Triangle& t) { return (t.a + t.b + t.c) / 3.0; }

// Distance at which a ray enters a box, infinity if it misses it.
double entry(const Bvh::Node& node, const Vec3& origin, const Vec3& inverse) {
    const Vec3 near = (node.middle - node.half - origin) * inverse;
    const Vec3 far = (node.middle + node.half - origin) * inverse;
    double in = 0.0, out = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        // A ray in the plane of a face gives 0 · ∞; such a NaN limits nothing.
        in = std::fmax(in, std::fmin(near[i], far[i]));
        out = std::fmin(out, std::fmax(near[i], far[i]));
    }
    return in <= out ? in : std::numeric_limits<double>::infinity();
}

// T. Möller, B. Trumbore: Fast, minimum storage ray–triangle intersection (1997).
double distance_to(const Triangle& t, const Vec3& origin, const Vec3& direction) {
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

Box Bvh::box() const {
    if (nodes_.empty()) return {};
    return {nodes_[0].middle - nodes_[0].half, nodes_[0].middle + nodes_[0].half};
}

void Bvh::split(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
    Box box, centres;
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
                                const Skip& skip) {
    std::optional<RayHit> best;
    if (bvh.nodes().empty()) return best;
    const Vec3 inverse = 1.0 / direction;
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const Bvh::Node& node = bvh.nodes()[stack.back()];
        stack.pop_back();
        if (entry(node, origin, inverse) > reach) continue;
        if (node.count == 0) {
            stack.push_back(node.first);
            stack.push_back(node.first + 1);
            continue;
        }
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const Triangle& t = bvh.triangles()[i];
            const double distance = distance_to(t, origin, direction);
            if (distance > reach || (best && distance >= best->distance) || (skip && skip(t.part))) continue;
            best = RayHit{distance, i};
            reach = distance;
        }
    }
    return best;
}

}  // namespace bolt::geometry
