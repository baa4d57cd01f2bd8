// Tests of distance fields, surface extraction and mesh cutting.
#include "tools/assets/sculpt/field.hpp"

#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace sculpt_field_test {

using namespace bolt;
using namespace bolt::sculpt;

TEST_CASE("Field: the distance of a round cone equals brute force over a growing sphere") {
    Random random(1);
    const Vec3 a(0.1, -0.2, 0.3);
    const Vec3 b(0.6, 0.4, -0.1);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        double nearest = 1e9;
        for (int k = 0; k <= 4000; ++k) {
            const double t = k / 4000.0;
            nearest = std::min(nearest, glm::length(p - (a + t * (b - a))) - (0.3 + t * (0.1 - 0.3)));
        }
        CHECK(round_cone(p, a, b, 0.3, 0.1) == doctest::Approx(nearest).epsilon(1e-5));
    }
}

TEST_CASE("Field: a round cone with one sphere inside the other is the larger sphere") {
    CHECK(round_cone(Vec3(3, 0, 0), Vec3(0.0), Vec3(0.1, 0, 0), 1.0, 0.2) == doctest::Approx(2.0));
}

TEST_CASE("Field: a blend acts only within its width") {
    CHECK(smooth_union(0.3, 0.1, 0.1) == doctest::Approx(0.1));
    CHECK(smooth_union(0.1, 0.1, 0.1) == doctest::Approx(0.075));
    CHECK(smooth_intersection(0.3, 0.1, 0.1) == doctest::Approx(0.3));
    CHECK(smooth_difference(-0.3, -0.1, 0.05) == doctest::Approx(0.1));
}

TEST_CASE("Field: the extracted surface of a ball is closed, lies on the ball and has its volume") {
    const SignedDistanceField ball = [](const Vec3& p) { return glm::length(p) - 1.0; };
    const TriMesh mesh = extract(ball, {Vec3(-1.3), Vec3(1.3)}, 0.05);
    CHECK(open_edges(mesh) == 0);
    CHECK(volume(mesh) == doctest::Approx(4.0 / 3.0 * pi).epsilon(2e-3));
    for (const Vec3& p : mesh.positions) CHECK(std::abs(glm::length(p) - 1.0) < 1e-6);
    // Euler: V − E + F = 2, and a closed mesh has 3F/2 edges.
    const auto faces = static_cast<long>(mesh.triangles.size());
    CHECK(static_cast<long>(mesh.positions.size()) - faces / 2 == 2);
}

TEST_CASE("Mesh: open_edges counts the edges of holes") {
    const SignedDistanceField ball = [](const Vec3& p) { return glm::length(p) - 1.0; };
    TriMesh mesh = extract(ball, {Vec3(-1.3), Vec3(1.3)}, 0.1);
    mesh.triangles.pop_back();
    CHECK(open_edges(mesh) == 3);
}

TEST_CASE("Mesh: cut() keeps the surface closed and leaves no triangle across the line") {
    const SignedDistanceField ball = [](const Vec3& p) { return glm::length(p) - 1.0; };
    TriMesh mesh = extract(ball, {Vec3(-1.3), Vec3(1.3)}, 0.1);
    const double before = volume(mesh);
    const auto height = [](const Vec3& p) { return p.y - 0.21 - 0.1 * p.x; };
    cut(mesh, height);
    CHECK(open_edges(mesh) == 0);
    CHECK(volume(mesh) == doctest::Approx(before).epsilon(5e-3));
    for (const IndexTriangle& t : mesh.triangles) {
        double low = 0.0;
        double high = 0.0;
        for (const std::uint32_t v : t) {
            low = std::min(low, height(mesh.positions[v]));
            high = std::max(high, height(mesh.positions[v]));
        }
        CHECK(std::min(-low, high) < 1e-9);
    }
}

}  // namespace sculpt_field_test
