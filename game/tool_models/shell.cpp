#include "game/tool_models/shell.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace bolt::tool_models {

namespace {

using TriangleIndices = std::array<std::uint32_t, 3>;

double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }

double area(const Vec2& a, const Vec2& b, const Vec2& c) { return 0.5 * cross(b - a, c - a); }

bool in_triangle(const Vec2& p, const Vec2& a, const Vec2& b, const Vec2& c) {
    return area(a, b, p) >= 0.0 && area(b, c, p) >= 0.0 && area(c, a, p) >= 0.0;
}

// Joins two loops by quadrangles, each divided along its shorter diagonal.
void join(Shell& shell, std::size_t below, std::size_t above, std::size_t size) {
    for (std::size_t k = 0; k < size; ++k) {
        const std::size_t next = (k + 1) % size;
        const auto a = static_cast<std::uint32_t>(below + k), b = static_cast<std::uint32_t>(below + next);
        const auto c = static_cast<std::uint32_t>(above + next), d = static_cast<std::uint32_t>(above + k);
        const Vec3 rising = shell.points[c] - shell.points[a], falling = shell.points[d] - shell.points[b];
        if (glm::dot(rising, rising) <= glm::dot(falling, falling) * (1.0 + 1e-9)) {
            shell.triangles.push_back({a, b, c});
            shell.triangles.push_back({a, c, d});
        } else {
            shell.triangles.push_back({a, b, d});
            shell.triangles.push_back({b, c, d});
        }
    }
}

// The loop in its own plane (Newell's normal), seen against the normal.
std::vector<Vec2> flattened(std::span<const Vec3> loop) {
    Vec3 normal(0.0);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3 &a = loop[i], &b = loop[(i + 1) % loop.size()];
        normal += glm::cross(a - loop[0], b - loop[0]);
    }
    normal = glm::normalize(normal);
    const Vec3 least = std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    const Vec3 u = glm::normalize(glm::cross(least, normal)), v = glm::cross(normal, u);
    std::vector<Vec2> flat;
    for (const Vec3& p : loop) flat.emplace_back(glm::dot(p - loop[0], u), glm::dot(p - loop[0], v));
    return flat;
}

void cap(Shell& shell, std::size_t first, std::size_t size, bool reversed) {
    const std::vector<Vec2> flat = flattened(std::span(shell.points).subspan(first, size));
    for (const TriangleIndices& t : triangulate(flat)) {
        const auto index = [&](std::size_t i) { return static_cast<std::uint32_t>(first + t[i]); };
        shell.triangles.push_back(reversed ? TriangleIndices{index(0), index(2), index(1)}
                                           : TriangleIndices{index(0), index(1), index(2)});
    }
}

Shell joined(const std::vector<Loop>& loops, bool closed) {
    Shell shell;
    const std::size_t size = loops.front().size();
    for (const Loop& loop : loops) shell.points.insert(shell.points.end(), loop.begin(), loop.end());
    for (std::size_t i = 0; i + 1 < loops.size(); ++i) join(shell, i * size, (i + 1) * size, size);
    if (closed) {
        join(shell, (loops.size() - 1) * size, 0, size);
        return shell;
    }
    cap(shell, 0, size, true);
    cap(shell, (loops.size() - 1) * size, size, false);
    return shell;
}

}  // namespace

std::vector<TriangleIndices> triangulate(std::span<const Vec2> polygon) {
    std::vector<std::uint32_t> left(polygon.size());
    std::iota(left.begin(), left.end(), 0U);
    std::vector<TriangleIndices> triangles;
    const auto at = [&](std::size_t i) -> const Vec2& { return polygon[left[i % left.size()]]; };
    while (left.size() > 3) {
        // Cuts off the ear with the shortest new edge. Only corners that point inwards can lie in an ear.
        std::vector<std::size_t> inward;
        for (std::size_t i = 0; i < left.size(); ++i)
            if (area(at(i + left.size() - 1), at(i), at(i + 1)) <= 0.0) inward.push_back(i);
        std::size_t best = left.size();
        double shortest = std::numeric_limits<double>::max();
        for (std::size_t i = 0; i < left.size(); ++i) {
            const std::size_t before = (i + left.size() - 1) % left.size(), after = (i + 1) % left.size();
            const Vec2 &a = at(before), &b = at(i), &c = at(after);
            const double length = glm::dot(c - a, c - a);
            if (length >= shortest || area(a, b, c) <= 1e-9 * length) continue;
            if (std::any_of(inward.begin(), inward.end(), [&](std::size_t k) {
                    return k != before && k != i && k != after && in_triangle(at(k), a, b, c);
                }))
                continue;
            best = i;
            shortest = length;
        }
        if (best == left.size()) best = 0;  // only corners without area remain
        triangles.push_back(
            {left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

Shell loft(const std::vector<Loop>& loops) { return joined(loops, false); }
Shell closed_loft(const std::vector<Loop>& loops) { return joined(loops, true); }

void add_arc(std::vector<OutlinePoint>& outline, const Vec2& middle, double radius, double from, double to,
             int steps, double edge) {
    for (int i = 0; i <= steps; ++i) {
        const double angle = from + (to - from) * i / steps;
        outline.push_back({middle + radius * Vec2(std::cos(angle), std::sin(angle)), edge});
    }
}

Shell plate(std::span<const OutlinePoint> outline, double low, double high, int steps) {
    const std::size_t n = outline.size();
    // The direction in which each point moves when the outline shrinks; longer at corners.
    std::vector<Vec2> inward(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 in = glm::normalize(outline[i].at - outline[(i + n - 1) % n].at);
        const Vec2 out = glm::normalize(outline[(i + 1) % n].at - outline[i].at);
        const Vec2 a(-in.y, in.x), b(-out.y, out.x);
        inward[i] = (a + b) / std::max(0.3, 1.0 + glm::dot(a, b));
    }
    std::vector<Loop> loops;
    const auto add_ring = [&](double face, double up, int step) {
        const double angle = 0.5 * pi * step / steps;
        Loop loop;
        for (std::size_t i = 0; i < n; ++i) {
            const double edge = outline[i].edge;
            const Vec2 p = outline[i].at + edge * (1.0 - std::sin(angle)) * inward[i];
            loop.emplace_back(p.x, p.y, face - up * edge * (1.0 - std::cos(angle)));
        }
        loops.push_back(std::move(loop));
    };
    for (int i = 0; i <= steps; ++i) add_ring(low, -1.0, i);
    for (int i = steps; i >= 0; --i) add_ring(high, 1.0, i);
    return loft(loops);
}

Shell block(const Vec3& low, const Vec3& high, double corner, double edge, int steps) {
    std::vector<OutlinePoint> outline;
    const Vec2 a(low.x + corner, low.y + corner), b(high.x - corner, high.y - corner);
    const Vec2 middles[] = {{b.x, a.y}, {b.x, b.y}, {a.x, b.y}, {a.x, a.y}};
    for (int i = 0; i < 4; ++i)
        add_arc(outline, middles[i], corner, 0.5 * pi * (i - 1), 0.5 * pi * i, steps, edge);
    return plate(outline, low.z, high.z, steps);
}

namespace {

enum class LatheAxis : std::uint8_t { x, z };

std::vector<Loop> turned_loops(std::span<const ProfilePoint> profile, int segments, LatheAxis axis) {
    std::vector<Loop> loops;
    for (const ProfilePoint& p : profile) {
        Loop loop;
        for (int k = 0; k < segments; ++k) {
            const double angle = 2.0 * pi * k / segments;
            const double r = p.shape ? p.shape(angle, p.radius) : p.radius;
            const double c = r * std::cos(angle), s = r * std::sin(angle);
            loop.push_back(axis == LatheAxis::z ? Vec3(c, s, p.along) : Vec3(p.along, c, s));
        }
        loops.push_back(std::move(loop));
    }
    return loops;
}

// The radius of a regular polygon with `sides` sides, one of which is perpendicular to the direction 0.
double polygon_radius(double angle, double radius, int sides) {
    return radius / std::cos(std::remainder(angle, 2.0 * pi / sides));
}

}  // namespace

Shell lathe_z(std::span<const ProfilePoint> profile, int segments) {
    return loft(turned_loops(profile, segments, LatheAxis::z));
}

Shell lathe_x(std::span<const ProfilePoint> profile, int segments) {
    return loft(turned_loops(profile, segments, LatheAxis::x));
}

Shell closed_lathe_z(std::span<const ProfilePoint> profile, int segments) {
    return closed_loft(turned_loops(profile, segments, LatheAxis::z));
}

double hexagon_radius(double angle, double radius) { return polygon_radius(angle, radius, 6); }

double twelve_point_radius(double angle, double radius) {
    return std::max(polygon_radius(angle, radius, 6), polygon_radius(angle + pi / 6.0, radius, 6));
}

double square_radius(double angle, double radius) { return polygon_radius(angle, radius, 4); }

Shell moved(Shell shell, const std::function<Vec3(const Vec3&)>& map) {
    for (Vec3& p : shell.points) p = map(p);
    return shell;
}

double volume(const Shell& shell) {
    double six = 0.0;
    for (const TriangleIndices& t : shell.triangles)
        six += glm::dot(shell.points[t[0]], glm::cross(shell.points[t[1]], shell.points[t[2]]));
    return six / 6.0;
}

}  // namespace bolt::tool_models
