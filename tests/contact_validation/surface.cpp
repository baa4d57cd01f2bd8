// Tests of the contact oracle against closed forms and against plain loops over all triangles.
#include "tools/verify/oracle/contact_oracle.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/base/random.hpp"
#include "tests/collision/support.hpp"
#include "tools/author/geometry/bvh.hpp"

using namespace bolt;
using namespace bolt::contact_oracle;

namespace {

ClosedSurface cube() {
    return contact_test::surface_of(contact_test::box(Vec3(-10.0) * mm, Vec3(10.0) * mm).mesh());
}

double cube_distance(const Vec3& p) {  // m, signed
    const Vec3 q = glm::abs(p) - 10.0 * mm;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

}  // namespace

TEST_CASE("Contact oracle: signed distance and winding number of points near a cube are exact") {
    const ClosedSurface surface = cube();
    Random random(1);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p = 8.0 * mm * Vec3(random.normal(), random.normal(), random.normal());
        CHECK(signed_distance(surface, p, 1.0) == doctest::Approx(cube_distance(p)).epsilon(1e-9).scale(1.0));
        CHECK(winding(surface, p) == (cube_distance(p) < 0.0 ? 1 : 0));
    }
    // Rays from these points pass through vertices and along diagonals of faces.
    for (const Vec3& p : {Vec3(0.0), Vec3(5.0, 5.0, 5.0) * mm, Vec3(0.0, 5.0, -5.0) * mm})
        CHECK(winding(surface, p) == 1);
}

TEST_CASE("Contact oracle: the gap of two cubes is exact face to face, edge to face and edge to edge") {
    const ClosedSurface a = cube();
    const double diagonal = std::sqrt(2.0) * 10.0 * mm;
    const Quat about_z = rotation(Vec3(0.0, 0.0, 0.25 * pi)), about_y = rotation(Vec3(0.0, 0.25 * pi, 0.0));
    const auto gap_at = [&](const Vec3& at, const Quat& turn) {
        return gap(a.tree, a.tree, {at, turn}, 1.0);
    };
    CHECK(gap_at(Vec3(23.0, 3.0, -4.0) * mm, Quat(1, 0, 0, 0)) == doctest::Approx(3.0 * mm));
    CHECK(gap_at(Vec3(10.0 * mm + diagonal + 2.0 * mm, 0.0, 0.0), about_z) == doctest::Approx(2.0 * mm));
    // Each cube is turned by 45 degrees, about perpendicular axes, so that the nearest features are two skew
    // edges.
    const Pose first{Vec3(0.0), about_y}, second{Vec3(2.0 * diagonal + 1.5 * mm, 0.0, 0.0), about_z};
    CHECK(gap(a.tree, a.tree, inverse(first) * second, 1.0) == doctest::Approx(1.5 * mm));
    CHECK_FALSE(cross(a.tree, a.tree, inverse(first) * second));
    const Pose in{Vec3(2.0 * diagonal - 0.01 * mm, 0.0, 0.0), about_z};
    CHECK(cross(a.tree, a.tree, inverse(first) * in));
    CHECK(gap(a.tree, a.tree, {Vec3(1.0, 0.0, 0.0), Quat(1, 0, 0, 0)}, 5.0 * mm) == 5.0 * mm);
}

TEST_CASE("Contact oracle: the depth of a cube in another is that of its deepest edge or face") {
    const ClosedSurface a = cube();
    const DepthOptions depths{.min_depth = 5e-6, .stop_depth = 1.0, .tolerance = 1e-7};
    const double diagonal = std::sqrt(2.0) * 10.0 * mm;
    const Quat about_z = rotation(Vec3(0.0, 0.0, 0.25 * pi));
    for (const double in : {0.02 * mm, 0.3 * mm, 4.0 * mm}) {
        const Pose pose{Vec3(10.0 * mm + diagonal - in, 0.0, 1.0 * mm), about_z};
        CHECK(depth_in(a.tree, a, pose, depths) == doctest::Approx(in).epsilon(1e-3));
        // Face against face: the whole face has the same depth.
        const Pose flat{Vec3(20.0 * mm - in, 1.0 * mm, 2.0 * mm), Quat(1, 0, 0, 0)};
        CHECK(depth_in(a.tree, a, flat, depths) == doctest::Approx(in).epsilon(1e-3));
    }
    CHECK(depth_in(a.tree, a, {Vec3(21.0 * mm, 0.0, 0.0), Quat(1, 0, 0, 0)}, depths) == 0.0);
    // With stop_depth the search may stop early, but not before that depth.
    const Pose far_in{Vec3(12.0 * mm, 1.0 * mm, 2.0 * mm), Quat(1, 0, 0, 0)};
    CHECK(depth_in(a.tree, a, far_in, {.min_depth = 5e-6, .stop_depth = 1.0 * mm, .tolerance = 1e-6}) >=
          1.0 * mm);
}

TEST_CASE("Contact oracle: the bounding-volume tree gives the same results as loops over all triangles") {
    const std::vector<geometry::Triangle> ball =
        contact_test::surface_of(contact_test::ball(9.0 * mm, 8).mesh()).tree.triangles();
    const std::vector<geometry::Triangle> wrench =
        contact_test::surface_of(contact_test::wrench().mesh()).tree.triangles();
    const ClosedSurface a = make_surface(wrench), b = make_surface(ball);
    Random random(3);
    int inside = 0, crossing = 0, apart = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = contact_test::near_surface(a, 3.0 * mm, random);
        double least = 1.0;
        for (const geometry::Triangle& t : wrench) least = std::min(least, point_triangle(p, t));
        CHECK(nearest(a.tree, p, 1.0).distance == least);
        CHECK(winding(a, p) == winding_by_solid_angle(a.tree, p));
        inside += winding(a, p) == 1 ? 1 : 0;
    }
    for (int i = 0; i < 40; ++i) {
        const Pose pose{contact_test::near_surface(a, 20.0 * mm, random), random_turn(random)};
        bool crosses = false;
        double least = 1.0;
        for (const geometry::Triangle& s : wrench)
            for (const geometry::Triangle& t : ball) {
                const geometry::Triangle placed{pose * t.a, pose * t.b, pose * t.c, 0};
                crosses = crosses || geometry::triangles_cross(s, placed);
                least = std::min(least, triangle_triangle(s, placed));
            }
        CHECK(cross(a.tree, b.tree, pose) == crosses);
        CHECK((depth(a, b, pose) > 0.0) == crosses);
        if (!crosses) CHECK(gap(a.tree, b.tree, pose, 1.0) == doctest::Approx(least).epsilon(1e-9));
        (crosses ? crossing : apart) += 1;
    }
    CHECK(inside > 20);
    CHECK(crossing > 5);
    CHECK(apart > 5);
}
