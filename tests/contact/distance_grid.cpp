#include "haptics/contact/distance_grid.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/contact/support.hpp"

using namespace bolt;
using namespace bolt::contact;
using namespace contact_test;

TEST_CASE("the grid's bounds hold everywhere, and set aside most of what is far") {
    Random random(21);
    for (const ContactMesh& mesh : {casing().mesh(), ball(0.015).mesh(),
                                    moved(wrench().mesh(), {Vec3(3.0, -2.0, 1.0), random_turn(random)})}) {
        const Solid solid = make_solid({&mesh, 1}).value();
        const DistanceGrid grid = make_distance_grid(solid, 1e-3);
        const Soup triangles = soup(mesh);
        int told = 0;
        int far = 0;
        for (int i = 0; i < 20'000; ++i) {
            const Vec3 p =
                solid.middle + solid.radius * 1.2 *
                                   Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            const double distance = brute_signed_distance(triangles, p);
            const DistanceBounds bounds = distance_bounds(grid, p);
            REQUIRE(bounds.lower <= distance);
            REQUIRE(bounds.upper >= std::abs(distance));
            far += distance > 3e-3 ? 1 : 0;
            told += distance > 3e-3 && bounds.lower > 1e-3 ? 1 : 0;
        }
        CHECK(told > 0.8 * far);
    }
}

TEST_CASE("beyond the grid nothing is told, and without one") {
    const ContactMesh mesh = casing().mesh();
    const Solid solid = make_solid({&mesh, 1}).value();
    const DistanceGrid grid = make_distance_grid(solid, 1e-3);
    for (const Vec3& p :
         {Vec3(1.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, 1e9), Vec3(std::nan(""), 0.0, 0.0)}) {
        CHECK(distance_bounds(grid, p).lower < -1e9);
        CHECK(distance_bounds(grid, p).upper > 1e9);
    }
    CHECK(make_distance_grid(solid, 0.0).nodes.empty());
    CHECK(distance_bounds({}, Vec3(0.0)).lower < -1e9);
}
