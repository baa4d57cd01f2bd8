#include "haptics/collision/world.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

// A 20 mm cube at the origin, and walls.
struct CubeAndWalls {
    ContactMesh cube = box(Vec3(-10.0) * mm, Vec3(10.0) * mm).mesh();
    std::vector<ContactMesh> walls;
    CollisionWorld world;
    std::vector<SurfacePoint> points = sample_surface(cube, 4000);
    std::size_t body = 0;

    explicit CubeAndWalls(std::vector<ContactMesh> given, const Pose& pose = {}) : walls(std::move(given)) {
        std::vector<Obstacle> obstacles{{ObstacleId::nut(5), &cube, pose, true}};
        std::size_t id = 100;
        for (const ContactMesh& wall : walls)
            obstacles.push_back({ObstacleId::fixed(id++), &wall, {}, false});
        world = make_world(obstacles).value();
        body = find_body(world, ObstacleId::nut(5)).value();
    }
    [[nodiscard]] double share(const Vec3& eye) const {
        return visibility_of(world, body, points, eye).share;
    }
};

ContactMesh wall(const Vec3& low, const Vec3& high) { return box(low * mm, high * mm).mesh(); }

}  // namespace

TEST_CASE("Surface samples: they lie on the surface and are distributed by area") {
    const ContactMesh slab = box(Vec3(0.0), Vec3(40.0, 10.0, 1.0) * mm).mesh();
    const std::vector<SurfacePoint> points = sample_surface(slab, 2000);
    REQUIRE(points.size() == 2000);
    std::array<int, 6> on{};
    std::array<int, 2> half{};
    for (const SurfacePoint& spot : points) {
        CHECK(glm::length(spot.normal) == doctest::Approx(1.0));
        for (int k = 0; k < 3; ++k)
            if (std::abs(spot.normal[k]) > 0.5)
                ++on[static_cast<std::size_t>(2 * k + (spot.normal[k] > 0.0 ? 1 : 0))];
        if (spot.normal.z > 0.5) ++half[spot.at.x < 0.02 ? 0 : 1];
    }
    const double all = 2.0 * (400.0 + 40.0 + 10.0);
    CHECK(on[5] == doctest::Approx(2000.0 * 400.0 / all).epsilon(0.01));
    CHECK(on[3] == doctest::Approx(2000.0 * 40.0 / all).epsilon(0.03));
    CHECK(std::abs(half[0] - half[1]) < 20);
    CHECK(sample_surface(ContactMesh{}, 10).empty());
}

TEST_CASE("Visibility: without obstacles a body is fully visible, with its exact solid angle") {
    const CubeAndWalls setting({});
    const Vec3 eye(0.0, 0.0, 0.5);
    const Visibility seen = visibility_of(setting.world, setting.body, setting.points, eye);
    CHECK(seen.share == 1.0);
    // Solid angle of a square with side 2a at distance d, seen from above its middle: 4 asin(a² / (a² + d²)).
    // The top of the cube hides its sides from there.
    const double a = 0.01, d = 0.49;
    CHECK(seen.angle == doctest::Approx(4.0 * std::asin(a * a / (a * a + d * d))).epsilon(0.01));
}

TEST_CASE("Visibility: a wall hides the part of a body behind it") {
    const Vec3 eye(0.0, 0.0, 1.0);
    SUBCASE("half of the body") {
        const CubeAndWalls setting({wall({0.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(setting.share(eye) == doctest::Approx(0.5).epsilon(0.02));
        // The view from the far left is unobstructed.
        CHECK(setting.share(Vec3(-1.0, 0.0, 0.02)) == 1.0);
    }
    SUBCASE("a quarter of the body") {
        const CubeAndWalls setting({wall({0.0, 0.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(setting.share(eye) == doctest::Approx(0.75).epsilon(0.02));
    }
    SUBCASE("the whole body") {
        const CubeAndWalls setting({wall({-50.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(setting.share(eye) == 0.0);
    }
    SUBCASE("a wall behind the body hides none of it") {
        const CubeAndWalls setting({wall({-50.0, -50.0, -21.0}, {50.0, 50.0, -20.0})});
        CHECK(setting.share(eye) == 1.0);
    }
    SUBCASE("the share is the same for a rotated body") {
        const Pose turned{Vec3(0.0), rotation(Vec3(0.0, 0.0, pi / 2.0))};
        const CubeAndWalls setting({wall({0.0, -50.0, 20.0}, {50.0, 50.0, 21.0})}, turned);
        CHECK(setting.share(eye) == doctest::Approx(0.5).epsilon(0.02));
    }
}

TEST_CASE("Visibility: a disabled body hides nothing, and the far side of the body is not counted") {
    CubeAndWalls setting({wall({-50.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
    CHECK(setting.share(Vec3(0.0, 0.0, 1.0)) == 0.0);
    CHECK(setting.share(Vec3(0.0, 0.0, -1.0)) == 1.0);
    setting.world.bodies[0].enabled = false;
    CHECK(setting.share(Vec3(0.0, 0.0, 1.0)) == 1.0);
    CHECK(visibility_of(setting.world, setting.body, {}, Vec3(0.0, 0.0, 1.0)).share == 0.0);
    CHECK(visibility_of(setting.world, setting.body, setting.points, Vec3(0.0)).share == 0.0);  // eye inside
}

TEST_CASE("Visibility: a held body is occluded like a body of the world") {
    const CubeAndWalls setting({wall({0.0, -50.0, 40.0}, {50.0, 50.0, 41.0})}, Pose{Vec3(0.0, 0.0, -0.2)});
    const Solid cube = make_solid(std::span(&setting.cube, 1)).value();
    const Vec3 eye(0.0, 0.0, 1.0);
    const Visibility held = visibility_of(setting.world, cube, Pose{}, setting.points, eye);
    CHECK(held.share == doctest::Approx(0.5).epsilon(0.02));
    CHECK(visibility_of(setting.world, cube, Pose{Vec3(-0.1, 0.0, 0.0)}, setting.points, eye).share == 1.0);
    // The held body is not in the world, so it hides nothing.
    CHECK(setting.share(Vec3(-1.0, 0.0, -0.2)) == 1.0);
}

TEST_CASE("Surface samples: the outer samples exclude the inside of a hole") {
    // A frame of four bars around a square hole.
    const std::vector<ContactMesh> bars = {
        wall({-20.0, -20.0, 0.0}, {20.0, -10.0, 10.0}), wall({-20.0, 10.0, 0.0}, {20.0, 20.0, 10.0}),
        wall({-20.0, -10.0, 0.0}, {-10.0, 10.0, 10.0}), wall({10.0, -10.0, 0.0}, {20.0, 10.0, 10.0})};
    const Solid frame = make_solid(bars).value();
    const auto inward = [](const SurfacePoint& spot) {
        return std::abs(spot.normal.z) < 0.5 && glm::dot(spot.normal, spot.at) < 0.0;
    };
    const std::vector<SurfacePoint> all = sample_surface(frame.mesh, 2000),
                                    outer = sample_outer_surface(frame, 2000);
    CHECK(std::count_if(all.begin(), all.end(), inward) > 100);
    CHECK(std::count_if(outer.begin(), outer.end(), inward) == 0);
    CHECK(outer.size() > 1000);
}
