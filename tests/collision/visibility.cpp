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

constexpr double mm = 1e-3;

// A 20 mm cube in the origin, and walls.
struct Room {
    ContactMesh cube = box(Vec3(-10.0) * mm, Vec3(10.0) * mm).mesh();
    std::vector<ContactMesh> walls;
    CollisionWorld world;
    std::vector<SurfacePoint> spots = sample_surface(cube, 4000);
    std::size_t body = 0;

    explicit Room(std::vector<ContactMesh> given, const Pose& pose = {}) : walls(std::move(given)) {
        std::vector<Obstacle> obstacles{{ObstacleId::nut(5), &cube, pose, true}};
        std::size_t id = 100;
        for (const ContactMesh& wall : walls)
            obstacles.push_back({ObstacleId::fixed(id++), &wall, {}, false});
        world = make_world(obstacles).value();
        body = find_body(world, ObstacleId::nut(5)).value();
    }
    [[nodiscard]] double share(const Vec3& eye) const { return visibility_of(world, body, spots, eye).share; }
};

ContactMesh wall(const Vec3& low, const Vec3& high) { return box(low * mm, high * mm).mesh(); }

}  // namespace

TEST_CASE("spots are spread by area, and lie on the surface") {
    const ContactMesh slab = box(Vec3(0.0), Vec3(40.0, 10.0, 1.0) * mm).mesh();
    const std::vector<SurfacePoint> spots = sample_surface(slab, 2000);
    REQUIRE(spots.size() == 2000);
    std::array<int, 6> on{};
    std::array<int, 2> half{};
    for (const SurfacePoint& spot : spots) {
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

TEST_CASE("alone all of a body is seen, and it appears as large as it is") {
    const Room room({});
    const Vec3 eye(0.0, 0.0, 0.5);
    const Visibility seen = visibility_of(room.world, room.body, room.spots, eye);
    CHECK(seen.share == 1.0);
    // The solid angle of a square from above its middle: 4 asin(a² / (a² + d²)), side 2a, distance d; the
    // sides of the cube are hidden by its top from there.
    const double a = 0.01, d = 0.49;
    CHECK(seen.angle == doctest::Approx(4.0 * std::asin(a * a / (a * a + d * d))).epsilon(0.01));
}

TEST_CASE("a wall hides what is behind it") {
    const Vec3 eye(0.0, 0.0, 1.0);
    SUBCASE("half") {
        const Room room({wall({0.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(room.share(eye) == doctest::Approx(0.5).epsilon(0.02));
        // From far to the left nothing is in the way.
        CHECK(room.share(Vec3(-1.0, 0.0, 0.02)) == 1.0);
    }
    SUBCASE("a quarter") {
        const Room room({wall({0.0, 0.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(room.share(eye) == doctest::Approx(0.75).epsilon(0.02));
    }
    SUBCASE("all") {
        const Room room({wall({-50.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
        CHECK(room.share(eye) == 0.0);
    }
    SUBCASE("nothing, behind the body") {
        const Room room({wall({-50.0, -50.0, -21.0}, {50.0, 50.0, -20.0})});
        CHECK(room.share(eye) == 1.0);
    }
    SUBCASE("as much wherever body and eye are turned to") {
        const Pose turned{Vec3(0.0), rotation(Vec3(0.0, 0.0, pi / 2.0))};
        const Room room({wall({0.0, -50.0, 20.0}, {50.0, 50.0, 21.0})}, turned);
        CHECK(room.share(eye) == doctest::Approx(0.5).epsilon(0.02));
    }
}

TEST_CASE("what is off hides nothing, and what faces away is not counted") {
    Room room({wall({-50.0, -50.0, 20.0}, {50.0, 50.0, 21.0})});
    CHECK(room.share(Vec3(0.0, 0.0, 1.0)) == 0.0);
    CHECK(room.share(Vec3(0.0, 0.0, -1.0)) == 1.0);
    room.world.bodies[0].on = false;
    CHECK(room.share(Vec3(0.0, 0.0, 1.0)) == 1.0);
    CHECK(visibility_of(room.world, room.body, {}, Vec3(0.0, 0.0, 1.0)).share == 0.0);
    CHECK(visibility_of(room.world, room.body, room.spots, Vec3(0.0)).share == 0.0);  // from within
}

TEST_CASE("what is held in the hand is seen as a body of the world would be") {
    const Room room({wall({0.0, -50.0, 40.0}, {50.0, 50.0, 41.0})}, Pose{Vec3(0.0, 0.0, -0.2)});
    const Solid cube = make_solid(std::span(&room.cube, 1)).value();
    const Vec3 eye(0.0, 0.0, 1.0);
    const Visibility held = visibility_of(room.world, cube, Pose{}, room.spots, eye);
    CHECK(held.share == doctest::Approx(0.5).epsilon(0.02));
    CHECK(visibility_of(room.world, cube, Pose{Vec3(-0.1, 0.0, 0.0)}, room.spots, eye).share == 1.0);
    // And it hides what is behind it no more than air does: it is not in the world.
    CHECK(room.share(Vec3(-1.0, 0.0, -0.2)) == 1.0);
}

TEST_CASE("of a body with a hole the spots inside it are left out") {
    // A frame of four bars about a square hole.
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
