// The truth itself, against closed forms.
#include "tools/truth/surface.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/base/random.hpp"
#include "tests/contact/support.hpp"

using namespace bolt;
using namespace bolt::truth;

namespace {

constexpr double mm = 1e-3;

Surface cube() { return make_surface(contact_test::box(Vec3(-10.0) * mm, Vec3(10.0) * mm).mesh()); }

double to_cube(const Vec3& p) {  // signed
    const Vec3 q = glm::abs(p) - 10.0 * mm;
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(0.0, std::max({q.x, q.y, q.z}));
}

}  // namespace

TEST_CASE("distance and side of points of a cube") {
    const Surface surface = cube();
    Random random(1);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 p = 8.0 * mm * Vec3(random.normal(), random.normal(), random.normal());
        CHECK(signed_distance(surface, p, 1.0) == doctest::Approx(to_cube(p)).epsilon(1e-9).scale(1.0));
        CHECK(winding(surface, p) == (to_cube(p) < 0.0 ? 1 : 0));
    }
    // Rays out of the middle along an edge's plane pass vertices and diagonals of faces.
    for (const Vec3& p : {Vec3(0.0), Vec3(5.0, 5.0, 5.0) * mm, Vec3(0.0, 5.0, -5.0) * mm})
        CHECK(winding(surface, p) == 1);
}

TEST_CASE("the gap of two cubes: face to face, edge to edge, corner to face") {
    const Surface a = cube();
    const double diagonal = std::sqrt(2.0) * 10.0 * mm;
    const Quat about_z = rotation(Vec3(0.0, 0.0, 0.25 * pi)), about_y = rotation(Vec3(0.0, 0.25 * pi, 0.0));
    const auto apart = [&](const Vec3& at, const Quat& turn) { return gap(a.tree, a.tree, {at, turn}, 1.0); };
    CHECK(apart(Vec3(23.0, 3.0, -4.0) * mm, Quat(1, 0, 0, 0)) == doctest::Approx(3.0 * mm));
    CHECK(apart(Vec3(10.0 * mm + diagonal + 2.0 * mm, 0.0, 0.0), about_z) == doctest::Approx(2.0 * mm));
    // Both turned by 45 degrees, about axes square to each other: two edges cross at a distance.
    const Pose first{Vec3(0.0), about_y}, second{Vec3(2.0 * diagonal + 1.5 * mm, 0.0, 0.0), about_z};
    CHECK(gap(a.tree, a.tree, inverse(first) * second, 1.0) == doctest::Approx(1.5 * mm));
    CHECK_FALSE(cross(a.tree, a.tree, inverse(first) * second));
    const Pose in{Vec3(2.0 * diagonal - 0.01 * mm, 0.0, 0.0), about_z};
    CHECK(cross(a.tree, a.tree, inverse(first) * in));
    CHECK(gap(a.tree, a.tree, {Vec3(1.0, 0.0, 0.0), Quat(1, 0, 0, 0)}, 5.0 * mm) == 5.0 * mm);
}

TEST_CASE("how deep a cube lies in another is what its deepest corner, edge or face says") {
    const Surface a = cube();
    const Depths depths{.least = 5e-6, .enough = 1.0, .tolerance = 1e-7};
    const double diagonal = std::sqrt(2.0) * 10.0 * mm;
    const Quat about_z = rotation(Vec3(0.0, 0.0, 0.25 * pi));
    for (const double in : {0.02 * mm, 0.3 * mm, 4.0 * mm}) {
        const Pose pose{Vec3(10.0 * mm + diagonal - in, 0.0, 1.0 * mm), about_z};
        CHECK(depth_in(a.tree, a, pose, depths) == doctest::Approx(in).epsilon(1e-3));
        // Flat on flat, all of it as deep.
        const Pose flat{Vec3(20.0 * mm - in, 1.0 * mm, 2.0 * mm), Quat(1, 0, 0, 0)};
        CHECK(depth_in(a.tree, a, flat, depths) == doctest::Approx(in).epsilon(1e-3));
    }
    CHECK(depth_in(a.tree, a, {Vec3(21.0 * mm, 0.0, 0.0), Quat(1, 0, 0, 0)}, depths) == 0.0);
    // Enough is enough.
    const Pose far_in{Vec3(12.0 * mm, 1.0 * mm, 2.0 * mm), Quat(1, 0, 0, 0)};
    CHECK(depth_in(a.tree, a, far_in, {.least = 5e-6, .enough = 1.0 * mm, .tolerance = 1e-6}) >= 1.0 * mm);
}
