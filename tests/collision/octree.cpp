#include "haptics/collision/triangle_octree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

TEST_CASE("Octree: the bounds hold everywhere and exclude most distant points") {
    Random random(21);
    for (const ContactMesh& mesh :
         {casing().mesh(), ball(0.015).mesh(),
          transformed(wrench().mesh(), {Vec3(3.0, -2.0, 1.0), random_turn(random)})}) {
        const Solid solid = make_solid({&mesh, 1}).value();
        const TriangleOctree octree = make_triangle_octree(solid, 1e-3);
        const ClosedSurface surface = surface_of(mesh);
        int told = 0;
        int far = 0;
        for (int i = 0; i < 20'000; ++i) {
            Vec3 p =
                solid.middle + solid.radius * 1.2 *
                                   Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
            if (i % 2 == 0) p = near_surface(surface, 2e-3, random);
            const double distance = contact_oracle::signed_distance(surface, p);
            const OctreeQuery seen = query(octree, p);
            REQUIRE(seen.lower <= distance);
            REQUIRE(seen.upper >= std::abs(distance));
            if (std::abs(distance) < listing_distance - 1e-6) REQUIRE(seen.leaf != nullptr);
            far += distance > 3e-3 ? 1 : 0;
            told += distance > 3e-3 && seen.lower > 1e-3 ? 1 : 0;
        }
        CHECK(told > 0.8 * far);
    }
}

TEST_CASE("Octree: outside the octree, or without one, the bounds are infinite") {
    const ContactMesh mesh = casing().mesh();
    const Solid solid = make_solid({&mesh, 1}).value();
    const TriangleOctree octree = make_triangle_octree(solid, 1e-3);
    for (const Vec3& p :
         {Vec3(1.0, 0.0, 0.0), Vec3(0.0, -1.0, 0.0), Vec3(0.0, 0.0, 1e9), Vec3(std::nan(""), 0.0, 0.0)}) {
        CHECK(query(octree, p).lower < -1e9);
        CHECK(query(octree, p).upper > 1e9);
        CHECK(query(octree, p).leaf == nullptr);
    }
    CHECK(make_triangle_octree(solid, 0.0).nodes.empty());
    CHECK(query({}, Vec3(0.0)).lower < -1e9);
}

TEST_CASE("Octree: the order in which threads fill root cells changes nothing") {
    const ContactMesh mesh = casing().mesh();
    const Solid solid = make_solid({&mesh, 1}).value();
    const TriangleOctree first = make_triangle_octree(solid, 0.25e-3);
    REQUIRE(first.root_counts[0] * first.root_counts[1] * first.root_counts[2] > 100);
    for (int repeat = 0; repeat < 3; ++repeat) {
        const TriangleOctree again = make_triangle_octree(solid, 0.25e-3);
        CHECK(again.triangles == first.triangles);
        CHECK(again.boxes == first.boxes);
        CHECK(std::equal(again.nodes.begin(), again.nodes.end(), first.nodes.begin(), first.nodes.end(),
                         [](const OctreeNode& a, const OctreeNode& b) {
                             return a.distance == b.distance && a.next == b.next;
                         }));
        CHECK(std::equal(again.leaves.begin(), again.leaves.end(), first.leaves.begin(), first.leaves.end(),
                         [](const OctreeLeaf& a, const OctreeLeaf& b) {
                             return a.begin == b.begin && a.end == b.end && a.boxes == b.boxes &&
                                    a.height == b.height && a.convex == b.convex && a.front == b.front;
                         }));
    }
}

TEST_CASE("Octree: near the surface a query over a leaf's list equals a full search") {
    Random random(22);
    int plain = 0;
    int several = 0;
    for (const ContactMesh& mesh : {casing().mesh(), ball(0.015).mesh(), wrench().mesh()}) {
        const Solid solid = make_solid({&mesh, 1}).value();
        const TriangleOctree octree = make_triangle_octree(solid, 1e-3);
        for (int i = 0; i < 20'000; ++i) {
            const auto [a, b, c] = corners(mesh, random.bits() % mesh.triangles.size());
            const Vec3 p = glm::mix(glm::mix(a, b, random.uniform()), c, random.uniform()) +
                           0.7e-3 * random.uniform() * random_direction(random);
            const OctreeQuery seen = query(octree, p);
            REQUIRE(seen.leaf != nullptr);
            const double band = random.uniform(0.1, 0.6) * 1e-3;
            std::array<SeparatingPlane, max_planes> listed;
            std::array<SeparatingPlane, max_planes> searched;
            const auto of_list = query_listed(solid, octree, seen, p, band, listed);
            const PointQueryResult of_search = query_point(solid, p, infinite_distance, band, searched);
            if (!of_list) {
                REQUIRE(std::abs(of_search.distance) > seen.unlisted_distance - 1e-9);
                REQUIRE(seen.unlisted_distance > listing_distance - 1e-4);
                continue;
            }
            REQUIRE(of_list->distance == of_search.distance);
            REQUIRE(of_list->planes == of_search.planes);
            for (std::size_t k = 0; k < of_list->planes; ++k) {
                REQUIRE(listed[k].distance == searched[k].distance);
                REQUIRE(listed[k].point == searched[k].point);
                REQUIRE(listed[k].normal == searched[k].normal);
            }
            plain += of_list->planes == 1 ? 1 : 0;
            several += of_list->planes > 1 ? 1 : 0;
        }
    }
    CHECK(plain > 1000);
    CHECK(several > 1000);
}
