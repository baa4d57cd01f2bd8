#include "haptics/contact/vicinity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/contact/support.hpp"

using namespace bolt;
using namespace bolt::contact;
using namespace contact_test;

TEST_CASE("the bounds of a vicinity hold everywhere, and set aside most of what is far") {
    Random random(21);
    for (const ContactMesh& mesh : {casing().mesh(), ball(0.015).mesh(),
                                    moved(wrench().mesh(), {Vec3(3.0, -2.0, 1.0), random_turn(random)})}) {
        const Solid solid = make_solid({&mesh, 1}).value();
        const Vicinity vicinity = make_vicinity(solid, 1e-3);
        const Soup triangles = soup(mesh);
        int told = 0;
        int far = 0;
        for (int i = 0; i < 20'000; ++i) {
            Vec3 p =
                solid.middle + solid.radius * 1.2 *
                                   Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (i % 2 == 0) {
                const auto& t = triangles[random.bits() % triangles.size()];
                p = t[0] + random.uniform() * (t[1] - t[0]) +
                    2e-3 * random.uniform() * random_direction(random);
            }
            const double distance = brute_signed_distance(triangles, p);
            const Look seen = look(vicinity, p);
            REQUIRE(seen.lower <= distance);
            REQUIRE(seen.upper >= std::abs(distance));
            if (std::abs(distance) < vicinity_reach - 1e-6) REQUIRE(seen.place != nullptr);
            far += distance > 3e-3 ? 1 : 0;
            told += distance > 3e-3 && seen.lower > 1e-3 ? 1 : 0;
        }
        CHECK(told > 0.8 * far);
    }
}

TEST_CASE("beyond a vicinity nothing is told, and without one") {
    const ContactMesh mesh = casing().mesh();
    const Solid solid = make_solid({&mesh, 1}).value();
    const Vicinity vicinity = make_vicinity(solid, 1e-3);
    for (const Vec3& p :
         {Vec3(1.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, 1e9), Vec3(std::nan(""), 0.0, 0.0)}) {
        CHECK(look(vicinity, p).lower < -1e9);
        CHECK(look(vicinity, p).upper > 1e9);
        CHECK(look(vicinity, p).place == nullptr);
    }
    CHECK(make_vicinity(solid, 0.0).nodes.empty());
    CHECK(look({}, Vec3(0.0)).lower < -1e9);
}

TEST_CASE("near the surface the lists tell what a search through everything does") {
    Random random(22);
    int plain = 0;
    int several = 0;
    for (const ContactMesh& mesh : {casing().mesh(), ball(0.015).mesh(), wrench().mesh()}) {
        const Solid solid = make_solid({&mesh, 1}).value();
        const Vicinity vicinity = make_vicinity(solid, 1e-3);
        for (int i = 0; i < 20'000; ++i) {
            const auto [a, b, c] = corners(mesh, random.bits() % mesh.triangles.size());
            const Vec3 p = glm::mix(glm::mix(a, b, random.uniform()), c, random.uniform()) +
                           0.7e-3 * random.uniform() * random_direction(random);
            const Look seen = look(vicinity, p);
            REQUIRE(seen.place != nullptr);
            const double band = random.uniform(0.1, 0.6) * 1e-3;
            std::array<Side, most_sides> listed;
            std::array<Side, most_sides> searched;
            const auto of_list = near_listed(solid, vicinity, seen, p, band, listed);
            const Near of_search = near_point(solid, p, nothing_near, band, searched);
            if (!of_list) {
                REQUIRE(std::abs(of_search.distance) > seen.unlisted - 1e-9);
                REQUIRE(seen.unlisted > vicinity_reach - 1e-4);
                continue;
            }
            REQUIRE(of_list->distance == of_search.distance);
            REQUIRE(of_list->sides == of_search.sides);
            for (std::size_t k = 0; k < of_list->sides; ++k) {
                REQUIRE(listed[k].distance == searched[k].distance);
                REQUIRE(listed[k].point == searched[k].point);
                REQUIRE(listed[k].normal == searched[k].normal);
            }
            plain += of_list->sides == 1 ? 1 : 0;
            several += of_list->sides > 1 ? 1 : 0;
        }
    }
    CHECK(plain > 1000);
    CHECK(several > 1000);
}
