#include "tests/collision/support.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/assets/gltf.hpp"
#include "engine/assets/model.hpp"

namespace contact_test {
namespace {

using namespace bolt;

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
ContactMesh Triangles::mesh() const { return collision::make_contact_mesh(vertices, indices).value(); }

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
    // The jaw is an arc of quads between an inner and an outer outline. The handle is a prism that continues
    // the arc.
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
    // Two adjacent pockets with a rib of 1 mm between them. All faces share one grid, so the mesh is closed.
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

ClosedSurface surface_of(const ContactMesh& mesh) { return surface_of(std::vector{mesh}); }

ClosedSurface surface_of(const std::vector<ContactMesh>& meshes) {
    std::vector<geometry::Triangle> triangles;
    for (const ContactMesh& mesh : meshes)
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = corners(mesh, t);
            triangles.push_back({a, b, c, 0});
        }
    return contact_oracle::make_surface(std::move(triangles));
}

Vec3 near_surface(const ClosedSurface& surface, double far, Random& random) {
    const std::vector<geometry::Triangle>& triangles = surface.tree.triangles();
    const geometry::Triangle& t = triangles[random.bits() % triangles.size()];
    const double u = random.uniform();
    const double v = random.uniform() * (1.0 - u);
    return t.a + u * (t.b - t.a) + v * (t.c - t.a) + random.uniform(0.0, far) * random_direction(random);
}

}  // namespace contact_test
