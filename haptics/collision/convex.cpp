#include "haptics/collision/convex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::collision {
namespace {

constexpr double coincidence = 1e-9;  // m; points closer than this count as equal
// cos 10°; two faces at a smaller angle are clipped against each other.
constexpr double min_parallel_cosine = 0.985;
// m by which a later candidate must be better, so that among equals a face precedes edges.
constexpr double face_preference = 1e-12;
constexpr double parallel_tolerance = 1e-12;  // of the squared sine of the angle between edges
constexpr std::uint32_t no_direction = ~0U;
constexpr std::size_t max_corners = 32;  // of a clipped face

// Intersects three planes. Returns false if they have no unique common point.
bool intersect(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c, Vec3& point) {
    const Vec3 bc = glm::cross(b.normal, c.normal);
    const double volume = glm::dot(a.normal, bc);
    if (std::abs(volume) < 1e-9) return false;
    point = (a.offset * bc + b.offset * glm::cross(c.normal, a.normal) +
             c.offset * glm::cross(a.normal, b.normal)) /
            volume;
    return true;
}

bool is_inside_all(std::span<const HalfSpace> half_spaces, const Vec3& p) {
    return std::all_of(half_spaces.begin(), half_spaces.end(),
                       [&](const HalfSpace& h) { return glm::dot(h.normal, p) <= h.offset + coincidence; });
}

void add_points(std::span<const HalfSpace> h, Convex& solid) {
    for (std::size_t i = 0; i < h.size(); ++i)
        for (std::size_t j = i + 1; j < h.size(); ++j)
            for (std::size_t k = j + 1; k < h.size(); ++k) {
                Vec3 p;
                if (!intersect(h[i], h[j], h[k], p) || !is_inside_all(h, p)) continue;
                const bool known = std::any_of(solid.points.begin(), solid.points.end(), [&](const Vec3& q) {
                    return glm::distance(p, q) < 1e3 * coincidence;
                });
                if (!known) solid.points.push_back(p);
            }
}

void add_face(const HalfSpace& plane, Convex& solid) {
    std::vector<std::uint32_t> loop;
    Vec3 middle(0.0);
    for (std::uint32_t i = 0; i < solid.points.size(); ++i)
        if (std::abs(glm::dot(plane.normal, solid.points[i]) - plane.offset) < 1e3 * coincidence) {
            loop.push_back(i);
            middle += solid.points[i];
        }
    if (loop.size() < 3) return;
    middle /= static_cast<double>(loop.size());
    const Vec3 x = glm::normalize(solid.points[loop[0]] - middle), y = glm::cross(plane.normal, x);
    const auto angle = [&](std::uint32_t i) {
        const Vec3 d = solid.points[i] - middle;
        return std::atan2(glm::dot(d, y), glm::dot(d, x));
    };
    std::sort(loop.begin(), loop.end(), [&](auto a, auto b) { return angle(a) < angle(b); });
    const auto begin = static_cast<std::uint32_t>(solid.loops.size());
    solid.loops.insert(solid.loops.end(), loop.begin(), loop.end());
    solid.faces.push_back({plane, begin, static_cast<std::uint32_t>(solid.loops.size())});
}

// Orients parallel edges the same way and sorts edges by direction.
void sort_by_direction(Convex& solid) {
    std::vector<Vec3>& directions = solid.directions;
    for (ConvexEdge& e : solid.edges) {
        const Vec3 along = glm::normalize(solid.points[e.to] - solid.points[e.from]);
        e.direction = 0;
        while (e.direction < directions.size() &&
               std::abs(glm::dot(along, directions[e.direction])) < 1.0 - 1e-12)
            ++e.direction;
        if (e.direction == directions.size()) directions.push_back(along);
        if (glm::dot(along, directions[e.direction]) > 0.0) continue;
        std::swap(e.from, e.to);
        std::swap(e.left, e.right);
    }
    std::stable_sort(solid.edges.begin(), solid.edges.end(),
                     [](const ConvexEdge& a, const ConvexEdge& b) { return a.direction < b.direction; });
}

std::span<const std::uint32_t> loop_of(const Convex& solid, std::uint32_t face) {
    const ConvexFace& f = solid.faces[face];
    return {solid.loops.data() + f.begin, f.end - f.begin};
}

// A solid transformed into the other's frame, without allocation.
struct PosedConvex {
    std::array<Vec3, max_convex_points> points, normals;  // of faces
    Vec3 middle{0.0};
    const Convex* solid = nullptr;

    PosedConvex(const Convex& of, const Pose& pose) : middle(pose * of.middle), solid(&of) {
        for (std::size_t i = 0; i < of.points.size(); ++i) points[i] = pose * of.points[i];
        for (std::size_t i = 0; i < of.faces.size(); ++i)
            normals[i] = pose.orientation * of.faces[i].plane.normal;
    }
    [[nodiscard]] double offset(std::uint32_t face) const {
        return glm::dot(normals[face], points[loop_of(*solid, face)[0]]);
    }
    [[nodiscard]] std::span<const Vec3> all() const { return {points.data(), solid->points.size()}; }
};

double min_along(std::span<const Vec3> points, const Vec3& n) {
    // Four independent minima, so that the comparisons do not wait for each other.
    std::array<double, 4> least;
    least.fill(glm::dot(points[0], n));
    std::size_t i = 0;
    for (; i + 4 <= points.size(); i += 4)
        for (std::size_t k = 0; k < 4; ++k) least[k] = std::min(least[k], glm::dot(points[i + k], n));
    for (; i < points.size(); ++i) least[0] = std::min(least[0], glm::dot(points[i], n));
    return std::min(std::min(least[0], least[1]), std::min(least[2], least[3]));
}

// The edges of the obstacle whose direction has a positive component along `n`.
EdgeSet edges_along(const Convex& obstacle, const Vec3& n) {
    EdgeSet set{};
    for (std::size_t d = 0; d < obstacle.directions.size(); ++d) {
        const std::uint64_t all = 0 - std::uint64_t{glm::dot(n, obstacle.directions[d]) > 0.0};
        for (std::size_t w = 0; w < 2; ++w) set[w] |= obstacle.in_direction[d][w] & all;
    }
    return set;
}

void select_sides(const Convex& obstacle, const Vec3& along, EdgeSet& left, EdgeSet& right) {
    left = right = {};
    for (std::size_t f = 0; f < obstacle.faces.size(); ++f) {
        const std::uint64_t all = 0 - std::uint64_t{glm::dot(obstacle.faces[f].plane.normal, along) > 0.0};
        for (std::size_t w = 0; w < 2; ++w) {
            left[w] |= obstacle.left_of[f][w] & all;
            right[w] |= obstacle.right_of[f][w] & all;
        }
    }
}

void test_edge_pair(const PosedConvex& tool, std::uint32_t i, const Convex& obstacle, std::uint32_t k,
                    Separation& best) {
    const ConvexEdge& e = tool.solid->edges[i];
    const ConvexEdge& f = obstacle.edges[k];
    const Vec3 p = tool.points[e.from], along = tool.points[e.to] - p;
    const Vec3 q = obstacle.points[f.from], other = obstacle.points[f.to] - q;
    Vec3 n = glm::cross(along, other);
    const double square_length = glm::dot(n, n);
    if (square_length < parallel_tolerance * glm::dot(along, along) * glm::dot(other, other)) return;
    if (glm::dot(n, q - obstacle.middle) < 0.0) n = -n;
    // Rejects most pairs without a square root.
    const double scaled = glm::dot(n, p - q);
    if (scaled * std::abs(scaled) < best.distance * std::abs(best.distance) * square_length) return;
    n /= std::sqrt(square_length);
    const double distance = glm::dot(n, p - q);
    if (distance > best.distance + face_preference) best = {distance, n, FeaturePair::edges, k, i};
}

// Tests the pairs of edges whose Gauss arcs (between the normals of an edge's faces, one solid's mirrored)
// cross: each edge's direction separates the normals of the other's faces, both in the same sense. Only then
// are both edges extreme along their cross product. Bit sets test one edge of the tool against all edges of
// the obstacle at once.
void test_edges(const PosedConvex& tool, const Convex& obstacle, Separation& best) {
    std::array<EdgeSet, max_convex_points> along_normal;  // by face of the tool
    for (std::size_t t = 0; t < tool.solid->faces.size(); ++t)
        along_normal[t] = edges_along(obstacle, tool.normals[t]);
    // Edges whose left or right face normal has a positive component along the tool's edge.
    EdgeSet left{}, right{};
    std::uint32_t known = no_direction;
    for (std::uint32_t i = 0; i < tool.solid->edges.size(); ++i) {
        const ConvexEdge& e = tool.solid->edges[i];
        const EdgeSet &a = along_normal[e.left], &b = along_normal[e.right];
        EdgeSet separating{a[0] ^ b[0], a[1] ^ b[1]};
        if ((separating[0] | separating[1]) == 0) continue;
        if (e.direction != known) {
            known = e.direction;
            select_sides(obstacle, tool.points[e.to] - tool.points[e.from], left, right);
        }
        for (std::uint32_t w = 0; w < 2; ++w) {
            std::uint64_t crossing = separating[w] & (left[w] ^ right[w]) & (left[w] ^ b[w]);
            for (; crossing != 0; crossing &= crossing - 1)
                test_edge_pair(tool, i, obstacle,
                               64 * w + static_cast<std::uint32_t>(std::countr_zero(crossing)), best);
        }
    }
}

struct Polygon {
    std::array<Vec3, max_corners> corners;
    std::size_t count = 0;

    void add(const Vec3& p) {
        if (count < corners.size()) corners[count++] = p;
    }
};

// The part of the polygon on the inner side of a plane (Sutherland-Hodgman).
Polygon clip(const Polygon& given, const Vec3& outward, double offset) {
    Polygon left;
    for (std::size_t i = 0; i < given.count; ++i) {
        const Vec3& p = given.corners[i];
        const Vec3& q = given.corners[(i + 1) % given.count];
        const double at_p = glm::dot(outward, p) - offset, at_q = glm::dot(outward, q) - offset;
        if (at_p <= 0.0) left.add(p);
        if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0))
            left.add(p + (q - p) * (at_p / (at_p - at_q)));
    }
    return left;
}

// The face whose normal is most aligned with `n`.
std::uint32_t max_aligned_face(std::span<const Vec3> normals, std::size_t count, const Vec3& n) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < count; ++i)
        if (glm::dot(normals[i], n) > glm::dot(normals[best], n)) best = i;
    return best;
}

// The closest points of two edges; Ericson, Real-Time Collision Detection, 5.1.9.
void nearest_on_edges(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e, Vec3& on_p, Vec3& on_q) {
    const double a = glm::dot(d, d), b = glm::dot(d, e), c = glm::dot(e, e);
    const Vec3 r = p - q;
    const double f = glm::dot(d, r), g = glm::dot(e, r), det = a * c - b * b;
    const double s = det > 0.0 ? std::clamp((b * g - c * f) / det, 0.0, 1.0) : 0.5;
    const double t = std::clamp((b * s + g) / c, 0.0, 1.0);
    on_p = p + s * d;
    on_q = q + t * e;
}

// The extreme point along −`n`; the mean of all points that are extreme up to the coincidence tolerance.
Vec3 extreme_point(std::span<const Vec3> points, const Vec3& n) {
    const double least = min_along(points, n);
    Vec3 sum(0.0);
    double count = 0.0;
    for (const Vec3& p : points)
        if (glm::dot(p, n) < least + coincidence) {
            sum += p;
            count += 1.0;
        }
    return sum / count;
}

}  // namespace

Result<Convex> make_convex(std::span<const HalfSpace> half_spaces) {
    Convex solid;
    add_points(half_spaces, solid);
    for (const HalfSpace& h : half_spaces) add_face(h, solid);
    if (solid.points.size() > max_convex_points || solid.faces.size() > max_convex_points)
        return fail(ErrorCode::bad_content,
                    fmt::format("a convex solid has {} corners and {} faces", solid.points.size(),
                                solid.faces.size()),
                    fmt::format("at most {} of each", max_convex_points));
    for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
        const auto loop = loop_of(solid, f);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint32_t from = loop[i], to = loop[(i + 1) % loop.size()];
            const auto other = std::find_if(solid.edges.begin(), solid.edges.end(), [&](const ConvexEdge& e) {
                return e.from == to && e.to == from;
            });
            if (other == solid.edges.end())
                solid.edges.push_back({from, to, f, f});
            else
                other->right = f;
        }
    }
    if (solid.edges.size() > max_edges)
        return fail(ErrorCode::bad_content, fmt::format("a convex solid has {} edges", solid.edges.size()),
                    fmt::format("at most {}", max_edges));
    sort_by_direction(solid);
    solid.left_of.assign(solid.faces.size(), {});
    solid.right_of.assign(solid.faces.size(), {});
    solid.in_direction.assign(solid.directions.size(), {});
    for (std::size_t k = 0; k < solid.edges.size(); ++k) {
        solid.left_of[solid.edges[k].left][k / 64] |= std::uint64_t{1} << (k % 64);
        solid.right_of[solid.edges[k].right][k / 64] |= std::uint64_t{1} << (k % 64);
        solid.in_direction[solid.edges[k].direction][k / 64] |= std::uint64_t{1} << (k % 64);
    }
    for (const Vec3& p : solid.points) solid.middle += p / static_cast<double>(solid.points.size());
    for (const Vec3& p : solid.points) solid.radius = std::max(solid.radius, glm::distance(p, solid.middle));
    return solid;
}

Separation separation(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle, double band) {
    Separation best;
    const Vec3 middle = to_obstacle * tool.middle;
    const double lower_bound = glm::distance(middle, obstacle.middle) - tool.radius - obstacle.radius;
    if (lower_bound > band) {
        best.distance = lower_bound;
        return best;
    }
    const PosedConvex posed(tool, to_obstacle);
    best.distance = -1e9;
    for (std::uint32_t i = 0; i < obstacle.faces.size(); ++i) {
        const HalfSpace& plane = obstacle.faces[i].plane;
        if (glm::dot(plane.normal, middle) - plane.offset < best.distance)
            continue;  // the tool's nearest point is no further out than its middle
        const double distance = min_along(posed.all(), plane.normal) - plane.offset;
        if (distance > best.distance + face_preference)
            best = {distance, plane.normal, FeaturePair::obstacle_face, i, 0};
        if (distance > band) return best;
    }
    for (std::uint32_t i = 0; i < tool.faces.size(); ++i) {
        const Vec3& n = posed.normals[i];
        const double distance = min_along(obstacle.points, n) - posed.offset(i);
        if (distance > best.distance + face_preference) best = {distance, -n, FeaturePair::tool_face, 0, i};
        if (distance > band) return best;
    }
    test_edges(posed, obstacle, best);
    return best;
}

std::size_t contact_points(const Convex& tool, const Convex& obstacle, const Pose& to_obstacle,
                           const Separation& s, std::span<Contact, max_contact_points> out) {
    const PosedConvex posed(tool, to_obstacle);
    const Vec3 n = s.normal;
    std::size_t count = 0;
    const auto write = [&](const Vec3& on_tool, double distance, std::uint32_t feature) {
        const auto known = out.first(count);
        const bool is_duplicate = std::any_of(known.begin(), known.end(), [&](const Contact& c) {
            return glm::distance(c.on_tool, on_tool) < 1e-5;
        });
        if (!is_duplicate && count < out.size())
            out[count++] = {on_tool, on_tool - distance * n, n, distance, {}, feature};
    };
    // First the point at which the separation was measured.
    if (s.features == FeaturePair::edges) {
        const ConvexEdge& e = tool.edges[s.on_tool];
        const ConvexEdge& f = obstacle.edges[s.on_obstacle];
        const Vec3 p = posed.points[e.from], q = obstacle.points[f.from];
        Vec3 on_tool, on_obstacle;
        nearest_on_edges(p, posed.points[e.to] - p, q, obstacle.points[f.to] - q, on_tool, on_obstacle);
        write(on_tool, s.distance, 0);
    }
    std::array<Vec3, max_convex_points> normals;
    for (std::size_t i = 0; i < obstacle.faces.size(); ++i) normals[i] = obstacle.faces[i].plane.normal;
    const std::uint32_t obstacle_face = s.features == FeaturePair::obstacle_face
                                            ? s.on_obstacle
                                            : max_aligned_face(normals, obstacle.faces.size(), n);
    const std::uint32_t tool_face = s.features == FeaturePair::tool_face
                                        ? s.on_tool
                                        : max_aligned_face(posed.normals, tool.faces.size(), -n);
    const HalfSpace& plane = obstacle.faces[obstacle_face].plane;
    const double cosine = glm::dot(plane.normal, n);
    if (cosine > min_parallel_cosine && -glm::dot(posed.normals[tool_face], n) > min_parallel_cosine) {
        Polygon overlap;
        for (const std::uint32_t i : loop_of(tool, tool_face)) overlap.add(posed.points[i]);
        const auto loop = loop_of(obstacle, obstacle_face);
        for (std::size_t i = 0; i < loop.size() && overlap.count > 0; ++i) {
            const Vec3& p = obstacle.points[loop[i]];
            const Vec3 outward = glm::cross(obstacle.points[loop[(i + 1) % loop.size()]] - p, n);
            overlap = clip(overlap, outward, glm::dot(outward, p));
        }
        for (std::size_t i = 0; i < overlap.count; ++i)
            write(overlap.corners[i], (glm::dot(plane.normal, overlap.corners[i]) - plane.offset) / cosine,
                  static_cast<std::uint32_t>(i + 1));
    }
    if (count > 0) return count;
    if (s.features == FeaturePair::tool_face) {
        const Vec3 on_obstacle = extreme_point(obstacle.points, -n);
        write(on_obstacle + s.distance * n, s.distance, 0);
    } else {
        write(extreme_point(posed.all(), n), s.distance, 0);
    }
    return count;
}

}  // namespace bolt::collision
