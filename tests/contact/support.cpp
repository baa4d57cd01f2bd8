#include "tests/contact/support.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/assets/gltf.hpp"
#include "engine/assets/topology.hpp"

namespace contact_test {
namespace {

using namespace bolt;
constexpr double mm = 1e-3;

double point_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
    const Vec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    bool over = true;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = t[i];
        const Vec3 b = t[(i + 1) % 3];
        over = over && glm::dot(glm::cross(b - a, p - a), n) >= 0.0;
        const double s = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
        least = std::min(least, glm::length(p - (a + s * (b - a))));
    }
    return over ? std::abs(glm::dot(p - t[0], n)) : least;
}

// By the four ends and the common perpendicular.
double segment_segment(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto to_segment = [](const Vec3& p, const Vec3& q, const Vec3& r) {
        const double s = std::clamp(glm::dot(p - q, r - q) / glm::dot(r - q, r - q), 0.0, 1.0);
        return glm::length(p - (q + s * (r - q)));
    };
    double least =
        std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
    const Vec3 n = glm::cross(b - a, d - c);
    const double nn = glm::dot(n, n);
    if (nn <= 1e-30) return least;
    const double s = glm::dot(glm::cross(c - a, d - c), n) / nn;
    const double t = glm::dot(glm::cross(c - a, b - a), n) / nn;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
        least = std::min(least, std::abs(glm::dot(c - a, n)) / std::sqrt(nn));
    return least;
}

bool pierces(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
    const Vec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double da = glm::dot(a - t[0], n);
    const double db = glm::dot(b - t[0], n);
    if ((da > 0.0) == (db > 0.0)) return false;
    const Vec3 p = a + (b - a) * (da / (da - db));
    for (std::size_t i = 0; i < 3; ++i)
        if (glm::dot(glm::cross(t[(i + 1) % 3] - t[i], p - t[i]), n) < 0.0) return false;
    return true;
}

bool boxes_meet(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
    for (int k = 0; k < 3; ++k) {
        if (std::max({s[0][k], s[1][k], s[2][k]}) < std::min({t[0][k], t[1][k], t[2][k]})) return false;
        if (std::max({t[0][k], t[1][k], t[2][k]}) < std::min({s[0][k], s[1][k], s[2][k]})) return false;
    }
    return true;
}

std::array<Vec3, 2> bounds(const Soup& soup) {
    std::array<Vec3, 2> box{soup[0][0], soup[0][0]};
    for (const auto& t : soup)
        for (const Vec3& p : t) box = {glm::min(box[0], p), glm::max(box[1], p)};
    return box;
}

bool triangles_cross(const std::array<Vec3, 3>& s, const std::array<Vec3, 3>& t) {
    for (std::size_t i = 0; i < 3; ++i)
        if (pierces(s[i], s[(i + 1) % 3], t) || pierces(t[i], t[(i + 1) % 3], s)) return true;
    return false;
}

}  // namespace

void Triangles::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& p : {a, b, c}) {
        indices.push_back(static_cast<std::uint32_t>(vertices.size()));
        vertices.emplace_back(p);
    }
}
void Triangles::quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    triangle(a, b, c);
    triangle(a, c, d);
}
ContactMesh Triangles::mesh() const { return contact::make_contact_mesh(vertices, indices).value(); }

Triangles box(const Vec3& low, const Vec3& high) {
    Triangles out;
    const auto at = [&](int x, int y, int z) {
        return Vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
    };
    out.quad(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
    out.quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
    out.quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
    out.quad(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
    out.quad(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
    out.quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
    return out;
}

Triangles ball(double radius, int rings) {
    const auto at = [&](int ring, int spoke) {
        const double polar = pi * ring / rings;
        const double around = pi * (spoke % (2 * rings)) / rings;
        if (ring == 0 || ring == rings) return Vec3(0.0, ring == 0 ? radius : -radius, 0.0);
        return radius *
               Vec3(std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around));
    };
    Triangles out;
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < 2 * rings; ++s) {
            if (r > 0) out.triangle(at(r, s), at(r, s + 1), at(r + 1, s));
            if (r + 1 < rings) out.triangle(at(r, s + 1), at(r + 1, s + 1), at(r + 1, s));
        }
    return out;
}

Triangles wrench() {
    Triangles out;
    // The jaw: an arc of quads between an inner and an outer outline, and the handle as a prism that the arc
    // holds.
    const double inner = 6.5 * mm;
    const double outer = 12.0 * mm;
    const auto at = [](double radius, double angle, double y) {
        return Vec3(radius * std::cos(angle), y, -radius * std::sin(angle));
    };
    constexpr int steps = 16;
    const double low = -2.5 * mm;
    const double high = 2.5 * mm;
    const auto angle = [](int i) { return to_radians(-150.0 + 300.0 * i / steps); };
    for (int i = 0; i < steps; ++i) {
        const double a = angle(i);
        const double b = angle(i + 1);
        out.quad(at(outer, a, low), at(outer, b, low), at(outer, b, high), at(outer, a, high));
        out.quad(at(inner, b, low), at(inner, a, low), at(inner, a, high), at(inner, b, high));
        out.quad(at(inner, a, high), at(outer, a, high), at(outer, b, high), at(inner, b, high));
        out.quad(at(inner, b, low), at(outer, b, low), at(outer, a, low), at(inner, a, low));
    }
    const double a = angle(0);
    const double b = angle(steps);
    out.quad(at(inner, a, low), at(outer, a, low), at(outer, a, high), at(inner, a, high));
    out.quad(at(outer, b, low), at(inner, b, low), at(inner, b, high), at(outer, b, high));
    return out;
}

Triangles casing() {
    Triangles out;
    const Vec3 size = Vec3(40.0, 20.0, 30.0) * mm;
    // Two pockets beside each other, a rib of 1 mm between them; everything is cut in one grid, so that it is
    // closed.
    const std::array<double, 6> x{0.0, 5.0 * mm, 20.0 * mm, 21.0 * mm, 35.0 * mm, 40.0 * mm};
    const std::array<double, 4> z{0.0, 5.0 * mm, 25.0 * mm, 30.0 * mm};
    const double floor = 8.0 * mm;
    const auto is_pocket = [](int i, int k) { return (i == 1 || i == 3) && k == 1; };
    const auto p = [&](int i, double y, int k) {
        return Vec3(x[static_cast<std::size_t>(i)], y, z[static_cast<std::size_t>(k)]);
    };
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 3; ++k) {
            const double y = is_pocket(i, k) ? floor : size.y;
            out.quad(p(i, y, k), p(i, y, k + 1), p(i + 1, y, k + 1), p(i + 1, y, k));
            out.quad(p(i, 0.0, k), p(i + 1, 0.0, k), p(i + 1, 0.0, k + 1), p(i, 0.0, k + 1));
            if (!is_pocket(i, k)) continue;
            out.quad(p(i, y, k), p(i, size.y, k), p(i, size.y, k + 1), p(i, y, k + 1));
            out.quad(p(i + 1, y, k), p(i + 1, y, k + 1), p(i + 1, size.y, k + 1), p(i + 1, size.y, k));
            out.quad(p(i, y, k), p(i + 1, y, k), p(i + 1, size.y, k), p(i, size.y, k));
            out.quad(p(i, y, k + 1), p(i, size.y, k + 1), p(i + 1, size.y, k + 1), p(i + 1, y, k + 1));
        }
    for (int i = 0; i < 5; ++i) {
        out.quad(p(i, 0.0, 0), p(i, size.y, 0), p(i + 1, size.y, 0), p(i + 1, 0.0, 0));
        out.quad(p(i, 0.0, 3), p(i + 1, 0.0, 3), p(i + 1, size.y, 3), p(i, size.y, 3));
    }
    for (int k = 0; k < 3; ++k) {
        out.quad(p(0, 0.0, k), p(0, 0.0, k + 1), p(0, size.y, k + 1), p(0, size.y, k));
        out.quad(p(5, 0.0, k), p(5, size.y, k), p(5, size.y, k + 1), p(5, 0.0, k + 1));
    }
    return out;
}

std::vector<ContactMesh> load_parts(const std::filesystem::path& path, const std::string& prefix) {
    const assets::Model model = assets::read_gltf(path).value();
    const std::vector<glm::mat4> world = assets::world_transforms(model);
    std::vector<ContactMesh> parts;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        if (model.nodes[n].mesh < 0 || !model.nodes[n].name.starts_with(prefix)) continue;
        Triangles out;
        for (const assets::Primitive& primitive :
             model.meshes[static_cast<std::size_t>(model.nodes[n].mesh)].primitives) {
            const auto first = static_cast<std::uint32_t>(out.vertices.size());
            for (const glm::vec3& v : primitive.positions)
                out.vertices.emplace_back(glm::dmat4(world[n]) * glm::dvec4(v, 1.0));
            for (const std::uint32_t i : assets::triangle_indices(primitive))
                out.indices.push_back(first + i);
        }
        parts.push_back(out.mesh());
    }
    return parts;
}

Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}
Vec3 random_direction(Random& random) { return random_turn(random) * Vec3(1.0, 0.0, 0.0); }

Soup soup(const ContactMesh& mesh, const Pose& pose) {
    Soup out;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners(mesh, t);
        out.push_back({pose * a, pose * b, pose * c});
    }
    return out;
}

double brute_signed_distance(const Soup& soup, const Vec3& point) {
    double distance = std::numeric_limits<double>::infinity();
    double winding = 0.0;
    for (const auto& t : soup) {
        distance = std::min(distance, point_triangle(point, t));
        const Vec3 a = t[0] - point;
        const Vec3 b = t[1] - point;
        const Vec3 c = t[2] - point;
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        winding +=
            2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                             la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return winding > 2.0 * pi ? -distance : distance;
}

double brute_distance(const Soup& a, const Soup& b) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& s : a)
        for (const auto& t : b)
            for (std::size_t i = 0; i < 3; ++i) {
                least = std::min({least, point_triangle(s[i], t), point_triangle(t[i], s)});
                for (std::size_t k = 0; k < 3; ++k)
                    least = std::min(least, segment_segment(s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]));
            }
    return least;
}

bool brute_crossing(const Soup& a, const Soup& b) {
    const auto [low, high] = bounds(b);
    for (const auto& s : a) {
        if (!boxes_meet(s, {low, high, low})) continue;
        for (const auto& t : b)
            if (boxes_meet(s, t) && triangles_cross(s, t)) return true;
    }
    return false;
}

bool deeper_than(double depth, const Soup& a, const Soup& b, double spacing) {
    for (const auto& [mine, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const auto& s : *mine) {
            if (std::none_of(other->begin(), other->end(),
                             [&](const auto& t) { return boxes_meet(s, t) && triangles_cross(s, t); }))
                continue;
            const double side =
                std::max({glm::length(s[1] - s[0]), glm::length(s[2] - s[1]), glm::length(s[0] - s[2])});
            const int steps = 1 + static_cast<int>(side / spacing);
            for (int i = 0; i <= steps; ++i)
                for (int k = 0; k <= steps - i; ++k) {
                    const Vec3 p =
                        s[0] + (s[1] - s[0]) * (double(i) / steps) + (s[2] - s[0]) * (double(k) / steps);
                    if (brute_signed_distance(*other, p) < -depth) return true;
                }
        }
    return false;
}

}  // namespace contact_test
