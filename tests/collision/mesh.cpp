#include "haptics/collision/mesh.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

TEST_CASE("Contact mesh: a box has twelve sharp convex edges and vertex pseudonormals on the diagonals") {
    const ContactMesh mesh = box(Vec3(-1.0), Vec3(1.0)).mesh();
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(mesh.watertight());
    REQUIRE(mesh.sharp_edges.size() == 12);
    for (const SharpEdge& edge : mesh.sharp_edges) {
        CHECK(edge.convex);
        CHECK(std::abs(glm::dot(edge.normals[0], edge.normals[1])) < 1e-6F);
        CHECK(glm::dot(edge.inward[0], edge.normals[1]) == doctest::Approx(-1.0));
    }
    // Pseudonormals are weighted by angle: each face has a weight of 90 degrees in any triangulation.
    for (std::size_t v = 0; v < 8; ++v)
        CHECK(glm::length(glm::normalize(mesh.vertex_normals[v]) - glm::normalize(mesh.vertices[v])) < 1e-6F);
}

TEST_CASE("Contact mesh: the inner edges of a pocket are concave") {
    const ContactMesh mesh = casing().mesh();
    std::size_t concave = 0;
    for (const SharpEdge& edge : mesh.sharp_edges) concave += edge.convex ? 0 : 1;
    CHECK(concave == 2 * 8);
    CHECK(mesh.watertight());
    CHECK(wrench().mesh().watertight());
    CHECK(ball(0.01).mesh().watertight());
}

TEST_CASE("Contact mesh: defects are counted, and invalid input is an error") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec3> corner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<std::uint32_t> indices{0, 1, 2};
    CHECK_FALSE(make_contact_mesh({}, {}));
    CHECK_FALSE(make_contact_mesh(corner, {}));
    CHECK_FALSE(make_contact_mesh(corner, std::vector<std::uint32_t>{0, 1}));
    CHECK_FALSE(make_contact_mesh(corner, std::vector<std::uint32_t>{0, 1, 3}));
    CHECK_FALSE(make_contact_mesh(corner, std::vector<std::uint32_t>{0, 1, 1}));
    for (const float bad : {nan, infinite, -infinite, 1e9F}) {
        auto spoiled = corner;
        spoiled[1].y = bad;
        CHECK_FALSE(make_contact_mesh(spoiled, indices));
    }
    const auto open = make_contact_mesh(corner, indices);
    REQUIRE(open);
    CHECK_FALSE(open->watertight());
    CHECK(open->open_edges == 3);

    Triangles thin = box(Vec3(0.0), Vec3(1.0));
    thin.triangle(Vec3(0.0), Vec3(0.5, 0.0, 0.0), Vec3(1.0, 0.0, 0.0));
    CHECK(thin.mesh().without_area == 1);
    CHECK(thin.mesh().triangles.size() == 12);

    Triangles forked = box(Vec3(0.0), Vec3(1.0));
    forked.triangle(Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.5, -1.0, 0.0));
    CHECK(forked.mesh().forked_edges == 1);
    CHECK_FALSE(forked.mesh().watertight());

    Triangles flipped = box(Vec3(0.0), Vec3(1.0));
    std::swap(flipped.indices[0], flipped.indices[1]);
    CHECK(flipped.mesh().open_edges == 3);
}
