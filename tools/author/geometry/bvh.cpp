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

struct Box {
    Vec3 middle, half;
};

Box box_of(const Bvh::Node& node) { return {node.middle, node.half}; }

Box box_of(const Triangle& t) {
    const Vec3 low = glm::min(glm::min(t.a, t.b), t.c), high = glm::max(glm::max(t.a, t.b), t.c);
    return {0.5 * (low + high), 0.5 * (high - low)};
}

// Separating-axis test of axis-aligned boxes and boxes that move, on the axes of their faces. Edges are left
// out, so boxes that are close to each other may count as overlapping.
class BoxTest {
  public:
    BoxTest(const RigidMotion& pose, const Sweep& sweep)
        : pose_(pose), sweep_(sweep), slide_(glm::abs(sweep.slide)) {
        for (int i = 0; i < 3; ++i) {
            across_[i] = glm::abs(pose.turn[i]);
            own_slide_[i] = std::abs(glm::dot(pose.turn[i], sweep.slide));
        }
    }

    // The box that contains `box` turned about +Y by at most the sweep's angle.
    [[nodiscard]] Box turned(const Box& box) const {
        if (sweep_.turn <= 0.0) return box;
        const double x = std::abs(box.middle.x) + box.half.x, z = std::abs(box.middle.z) + box.half.z;
        const double side = sweep_.turn, in = 0.5 * side * side;  // ≥ sin, ≥ 1 − cos
        return {box.middle, box.half + Vec3(x * in + z * side, 0.0, x * side + z * in)};
    }
    // `moving`: as turned() returns it.
    [[nodiscard]] bool separated(const Box& still, const Box& moving) const {
        const Vec3 d = pose_(moving.middle) - still.middle;
        const Vec3 reach = across_ * moving.half + still.half + slide_;
        if (std::abs(d.x) > reach.x || std::abs(d.y) > reach.y || std::abs(d.z) > reach.z) return true;
        for (int i = 0; i < 3; ++i)
            if (std::abs(glm::dot(d, pose_.turn[i])) >
                moving.half[i] + glm::dot(across_[i], still.half) + own_slide_[i])
                return true;
        return false;
    }

  private:
    const RigidMotion& pose_;
    const Sweep& sweep_;
    glm::dmat3 across_{1.0};  // absolute values of the rotation
    Vec3 slide_, own_slide_{0.0};
};

double size_of(const Bvh::Node& node) { return node.half.x + node.half.y + node.half.z; }

}  // namespace

bool triangles_cross(const Triangle& s, const Triangle& t) {
    if (on_one_side(s, t) || on_one_side(t, s)) return false;
    return segment_crosses(s.a, s.b, t) || segment_crosses(s.b, s.c, t) || segment_crosses(s.c, s.a, t) ||
           segment_crosses(t.a, t.b, s) || segment_crosses(t.b, t.c, s) || segment_crosses(t.c, t.a, s);
}

namespace {

// Calls `visit` for each pair of leaves whose boxes are not separated, until it returns true.
template <class Visit>
void visit_leaf_pairs(const Bvh& still, const Bvh& moving, const BoxTest& test, Visit&& visit) {
    if (still.nodes().empty() || moving.nodes().empty()) return;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack;
    stack.reserve(128);
    stack.emplace_back(0, 0);
    while (!stack.empty()) {
        const auto [i, k] = stack.back();
        stack.pop_back();
        const Bvh::Node &a = still.nodes()[i], &b = moving.nodes()[k];
        if (test.separated(box_of(a), test.turned(box_of(b)))) continue;
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
        if (visit(a, b)) return;
    }
}

}  // namespace

std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const RigidMotion& pose,
                                            const SkipPart& skip) {
    std::optional<std::uint32_t> found;
    visit_leaf_pairs(still, moving, BoxTest(pose, {}), [&](const Bvh::Node& a, const Bvh::Node& b) {
        for (std::uint32_t m = b.first; m < b.first + b.count; ++m) {
            const Triangle& own = moving.triangles()[m];
            const Triangle posed{pose(own.a), pose(own.b), pose(own.c), own.part};
            for (std::uint32_t n = a.first; n < a.first + a.count; ++n) {
                if (!triangles_cross(posed, still.triangles()[n]) ||
                    (skip && skip(still.triangles()[n].part)))
                    continue;
                found = n;
                return true;
            }
        }
        return false;
    });
    return found;
}

namespace {

// m by which `normal` separates the corners of a triangle from the plane through `point`; negative if they
// are on both sides.
double plane_distance(const Vec3& normal, const Vec3& point, const Triangle& t) {
    const double a = glm::dot(normal, t.a - point), b = glm::dot(normal, t.b - point),
                 c = glm::dot(normal, t.c - point);
    return std::max(std::min({a, b, c}), -std::max({a, b, c}));
}

// Largest distance of a corner from the line through `axis_point` along `axis`, m.
double radius_about(const Vec3& axis_point, const Vec3& axis, const Triangle& t) {
    double most = 0.0;
    for (const Vec3& p : {t.a, t.b, t.c}) {
        const Vec3 d = p - axis_point, off = d - glm::dot(d, axis) * axis;
        most = std::max(most, glm::dot(off, off));
    }
    return std::sqrt(most);
}

// Returns true if the plane of one of the triangles separates them in all motions of the sweep. `posed`: the
// moving triangle in the middle of the sweep.
bool plane_separates(const Triangle& still, const Triangle& posed, const RigidMotion& pose,
                     const Sweep& sweep) {
    const auto separates = [&](const Triangle& plane, const Triangle& other, double turned) {
        const Vec3 n = normal_of(plane);
        const double length = glm::length(n);
        if (length <= 0.0) return false;
        const double moved = (turned * length + std::abs(glm::dot(n, sweep.slide)));
        return plane_distance(n, plane.a, other) > moved;
    };
    // The rotation moves a point by at most its radius times the angle, as seen from either triangle.
    return separates(still, posed, radius_about(pose.shift, pose.turn[1], posed) * sweep.turn) ||
           separates(posed, still, radius_about(pose.shift, pose.turn[1], still) * sweep.turn);
}

}  // namespace

bool may_cross(const Bvh& still, const Bvh& moving, const RigidMotion& pose, const Sweep& sweep) {
    const BoxTest test(pose, sweep);
    bool found = false;
    visit_leaf_pairs(still, moving, test, [&](const Bvh::Node& a, const Bvh::Node& b) {
        for (std::uint32_t m = b.first; m < b.first + b.count && !found; ++m) {
            const Triangle& own = moving.triangles()[m];
            const Box box = test.turned(box_of(own));
            const Triangle posed{pose(own.a), pose(own.b), pose(own.c), own.part};
            for (std::uint32_t n = a.first; n < a.first + a.count && !found; ++n) {
                const Triangle& other = still.triangles()[n];
                found = !test.separated(box_of(other), box) && !plane_separates(other, posed, pose, sweep);
            }
        }
        return found;
    });
    return found;
}

namespace {

// The ranges of the distance from the axis +Y and of the height along it in which a body lies, m.
struct RadialBox {
    double near, far, low, high;

    // `box`: in the frame of the axis.
    explicit RadialBox(const Box& box)
        : near(std::hypot(std::max(std::abs(box.middle.x) - box.half.x, 0.0),
                          std::max(std::abs(box.middle.z) - box.half.z, 0.0))),
          far(std::hypot(std::abs(box.middle.x) + box.half.x, std::abs(box.middle.z) + box.half.z)),
          low(box.middle.y - box.half.y),
          high(box.middle.y + box.half.y) {}

    explicit RadialBox(const Triangle& t) : RadialBox(box_of(t)) {
        far = 0.0;
        for (const Vec3& p : {t.a, t.b, t.c}) far = std::max(far, std::hypot(p.x, p.z));
    }
    [[nodiscard]] bool overlaps(const RadialBox& other) const {
        return near <= other.far && other.near <= far && low <= other.high && other.low <= high;
    }
};

}  // namespace

bool may_cross_at_any_angle(const Bvh& still, const Bvh& moving, const RigidMotion& to_still, double height) {
    if (still.nodes().empty() || moving.nodes().empty()) return false;
    const glm::dmat3 back = glm::transpose(to_still.turn);
    const glm::dmat3 across{glm::abs(back[0]), glm::abs(back[1]), glm::abs(back[2])};
    const Vec3 down{0.0, height, 0.0};
    const auto in_moving = [&](const Vec3& p) { return back * (p - to_still.shift) - down; };
    const auto still_box = [&](const Bvh::Node& node) {
        return RadialBox(Box{in_moving(node.middle), across * node.half});
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
    while (!stack.empty()) {
        const auto [i, k] = stack.back();
        stack.pop_back();
        const Bvh::Node &a = still.nodes()[i], &b = moving.nodes()[k];
        if (!still_box(a).overlaps(RadialBox(box_of(b)))) continue;
        if (a.count == 0 && (b.count > 0 || size_of(a) >= size_of(b))) {
            stack.emplace_back(a.first, k);
            stack.emplace_back(a.first + 1, k);
        } else if (b.count == 0) {
            stack.emplace_back(i, b.first);
            stack.emplace_back(i, b.first + 1);
        } else {
            for (std::uint32_t n = a.first; n < a.first + a.count; ++n) {
                const Triangle& t = still.triangles()[n];
                const RadialBox box(Triangle{in_moving(t.a), in_moving(t.b), in_moving(t.c), t.part});
                for (std::uint32_t m = b.first; m < b.first + b.count; ++m)
                    if (box.overlaps(RadialBox(moving.triangles()[m]))) return true;
            }
        }
    }
    return false;
}

}  // namespace bolt::geometry
