// Facets that approximate a round surface have continuous normals; creases keep theirs.
#include "haptics/collision/narrow_phase.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/collision/support.hpp"

namespace collision_smooth_normals_test {

using namespace bolt;
using namespace bolt::collision;
using contact_test::Triangles;

namespace {

constexpr double radius = 0.02;

Triangles bar(int planes) {
    Triangles t;
    const auto at = [&](int i, double y) {
        const double a = 2.0 * pi * (i % planes) / planes;
        return Vec3(radius * std::sin(a), y, radius * std::cos(a));
    };
    for (int i = 0; i < planes; ++i) {
        t.quad(at(i, -0.05), at(i + 1, -0.05), at(i + 1, 0.05), at(i, 0.05));
        t.triangle(at(i, -0.05), Vec3(0, -0.05, 0), at(i + 1, -0.05));
        t.triangle(at(i, 0.05), at(i + 1, 0.05), Vec3(0, 0.05, 0));
    }
    return t;
}

struct Pair {
    CollisionWorld world;
    ToolShape tool;
    NarrowPhaseState near;

    Pair(const ContactMesh& obstacle, const ContactMesh& mesh) {
        const Obstacle still{ObstacleId::fixed(1), &obstacle, {}, false};
        Result<CollisionWorld> made = make_world({&still, 1});
        REQUIRE(made);
        world = std::move(*made);
        Result<ToolShape> shape = make_tool({&mesh, 1});
        REQUIRE(shape);
        tool = std::move(*shape);
        near = make_narrow_phase(world, tool);
    }
    // The nearest contact, with its smooth normal.
    Contact nearest(const Pose& pose) {
        std::array<Contact, 32> contacts;
        const ContactQueryResult found = find_contacts(world, tool, pose, 0.5e-3, near, contacts);
        REQUIRE(found.count > 0);
        const auto all = std::span(contacts).first(found.count);
        smooth_normals(world, tool, pose, all);
        for (const Contact& c : all) {
            if (c.smooth == Vec3(0.0)) continue;
            CHECK(glm::length(c.smooth) == doctest::Approx(1.0).epsilon(1e-9));
            CHECK(glm::dot(c.smooth, c.normal) >= std::cos(max_smoothing_angle) - 1e-9);
        }
        return all.front();
    }
};

double angle_between(const Vec3& a, const Vec3& b) { return std::acos(std::min(1.0, glm::dot(a, b))); }

// Pose of a die whose lowest corner is at `point`.
Pose die_on(const Vec3& point) {
    const Vec3 corner = glm::normalize(Vec3(-1.0)), down(0, 0, -1);
    const Quat turn = rotation(std::acos(glm::dot(corner, down)) * glm::normalize(glm::cross(corner, down)));
    return {point - 5e-3 * std::sqrt(3.0) * down, turn};
}

}  // namespace

TEST_CASE(
    "Smooth normals: a corner on a faceted bar gets the round normal, whichever of the two is the tool") {
    for (const int planes : {16, 24, 48}) {
        const ContactMesh round = bar(planes).mesh();
        const ContactMesh die = contact_test::box(Vec3(-5e-3), Vec3(5e-3)).mesh();
        Pair on_bar(round, die), on_die(die, round);
        double off = 0.0, facets_off = 0.0;
        for (int i = -200; i <= 200; ++i) {
            const double a = 0.4 * i / 200.0;
            const Vec3 radial(std::sin(a), 0.0, std::cos(a));
            const double within = std::remainder(a - pi / planes, 2.0 * pi / planes);
            const double facet = radius * std::cos(pi / planes) / std::cos(within);
            const Pose pose = die_on((facet + 60e-6) * radial + Vec3(0, 3.3e-3, 0));
            const Contact c = on_bar.nearest(pose);
            off = std::max(off, angle_between(c.smooth, radial));
            facets_off = std::max(facets_off, angle_between(c.normal, radial));
            const Contact other = on_die.nearest(inverse(pose));
            off = std::max(off, angle_between(-(pose.orientation * other.smooth), radial));
        }
        CAPTURE(planes);
        CHECK(to_degrees(off) < 0.02 * 360.0 / planes);
        CHECK(to_degrees(facets_off) > 0.4 * 360.0 / planes);
    }
}

TEST_CASE("Smooth normals: at the crease of a block the normal is unchanged") {
    const ContactMesh block = contact_test::box(Vec3(-0.02), Vec3(0.02)).mesh();
    Pair pair(block, contact_test::box(Vec3(-5e-3), Vec3(5e-3)).mesh());
    for (int i = -100; i <= 100; ++i) {
        const double a = 0.5 * i / 100.0;  // about the edge at x = z = 20 mm
        const Vec3 out(std::sin(0.25 * pi + a), 0.0, std::cos(0.25 * pi + a));
        const Contact c = pair.nearest(die_on(Vec3(0.02, 2e-3, 0.02) + 60e-6 * out));
        if (c.smooth != Vec3(0.0)) CHECK(angle_between(c.smooth, c.normal) < 1e-6);
    }
}

TEST_CASE("Smooth normals: normals are unchanged far from the surface and change gradually towards it") {
    const ContactMesh round = bar(48).mesh();
    Pair pair(round, contact_test::box(Vec3(-5e-3), Vec3(5e-3)).mesh());
    const double a = 0.1 * pi / 24.0;  // near the end of a facet
    const Vec3 radial(std::sin(a), 0.0, std::cos(a));
    double last = -1.0;
    for (double height = 0.35e-3; height > 20e-6; height -= 5e-6) {
        const Contact c = pair.nearest(die_on((radius + height) * radial + Vec3(0, 3.3e-3, 0)));
        const double by = c.smooth == Vec3(0.0) ? 0.0 : angle_between(c.smooth, c.normal);
        if (c.distance > smooth_far) CHECK(by == 0.0);
        if (last >= 0.0) CHECK(std::abs(by - last) < to_radians(0.4));
        last = by;
    }
    CHECK(last > to_radians(2.0));
}

TEST_CASE("Smooth normals: a ball's smooth normals point away from its middle") {
    const ContactMesh ball = contact_test::ball(0.01, 24).mesh();
    for (std::size_t t = 0; t < ball.triangles.size(); ++t) {
        CHECK(ball.creased[t] == 0);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 out = glm::normalize(Vec3(ball.vertices[ball.triangles[t][i]]));
            CHECK(to_degrees(angle_between(Vec3(ball.smooth_normals[t][i]), out)) < 1.5);
        }
    }
    const ContactMesh block = contact_test::box(Vec3(-0.02), Vec3(0.02)).mesh();
    for (std::size_t t = 0; t < block.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) CHECK(block.smooth_normals[t][i] == block.face_normals[t]);
}

}  // namespace collision_smooth_normals_test
