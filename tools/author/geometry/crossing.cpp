#include "tools/author/geometry/crossing.hpp"

#include <utility>

namespace bolt::geometry {

namespace {

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return glm::dot(glm::cross(b - a, c - a), d - a);
}

bool passes_through(const Vec3& p, const Vec3& q, const Triangle& t) {
    const double above = volume(t.a, t.b, t.c, p), below = volume(t.a, t.b, t.c, q);
    if (!(above * below < 0.0)) return false;
    const double u = volume(p, q, t.a, t.b), v = volume(p, q, t.b, t.c), w = volume(p, q, t.c, t.a);
    return (u >= 0.0 && v >= 0.0 && w >= 0.0) || (u <= 0.0 && v <= 0.0 && w <= 0.0);
}

// All of `t` on one side of the plane of `s`, or in it.
bool beside(const Triangle& s, const Triangle& t) {
    const Vec3 n = normal_of(s);
    const double a = glm::dot(n, t.a - s.a), b = glm::dot(n, t.b - s.a), c = glm::dot(n, t.c - s.a);
    return (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
}

// Separating axes of a box along the axes and one that is turned about Y.
bool apart(const Bvh::Node& still, const Bvh::Node& moving, const Pose& pose) {
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

bool cross(const Triangle& s, const Triangle& t) {
    if (beside(s, t) || beside(t, s)) return false;
    return passes_through(s.a, s.b, t) || passes_through(s.b, s.c, t) || passes_through(s.c, s.a, t) ||
           passes_through(t.a, t.b, s) || passes_through(t.b, t.c, s) || passes_through(t.c, t.a, s);
}

std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const Pose& pose,
                                            const Skip& skip) {
    if (still.nodes().empty() || moving.nodes().empty()) return std::nullopt;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [i, k] = stack.back();
        stack.pop_back();
        const Bvh::Node &a = still.nodes()[i], &b = moving.nodes()[k];
        if (apart(a, b, pose)) continue;
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
                if (cross(posed, still.triangles()[n]) && !(skip && skip(still.triangles()[n].part)))
                    return n;
        }
    }
    return std::nullopt;
}

}  // namespace bolt::geometry
