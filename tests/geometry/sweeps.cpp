// The conservative tests that spare the swing search most of its exact ones, against many exact ones.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "engine/base/random.hpp"
#include "tools/author/geometry/bvh.hpp"
#include "tools/author/geometry/free_swing.hpp"

namespace geometry_sweeps_test {

using namespace bolt;
using geometry::Bvh;
using geometry::RigidMotion;
using geometry::Triangle;

namespace {

Vec3 random_point(Random& random, double reach) {
    return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

std::vector<Triangle> cloud(Random& random, int count, double size, double reach, std::uint32_t part = 0) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
        const Vec3 at = random_point(random, reach);
        const auto corner = [&] { return at + random_point(random, size); };
        triangles.push_back({corner(), corner(), corner(), part});
    }
    return triangles;
}

RigidMotion random_motion(Random& random) {
    const Quat turn = glm::normalize(
        Quat(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.3));
    return {glm::mat3_cast(turn), random_point(random, 0.5)};
}

RigidMotion after(const RigidMotion& last, const RigidMotion& first) {
    return {last.turn * first.turn, last(first.shift)};
}

}  // namespace

TEST_CASE("Sweeps: triangles cross in no motion of a sweep that excludes it") {
    Random random(11);
    int excluded = 0;
    for (int round = 0; round < 600; ++round) {
        const Bvh still(cloud(random, 6, 0.15, 1.0)), moving(cloud(random, 6, 0.15, 1.0));
        const RigidMotion pose = random_motion(random);
        const geometry::Sweep sweep{random.uniform(0.0, 0.3), random_point(random, 0.1)};
        const bool may = geometry::may_cross(still, moving, pose, sweep);
        excluded += may ? 0 : 1;
        bool crossed = false;
        for (int i = 0; i < 40; ++i) {
            const RigidMotion own = RigidMotion::about_y(random.uniform(-1.0, 1.0) * sweep.turn, Vec3{0.0});
            RigidMotion moved = after(pose, own);
            moved.shift += random.uniform(-1.0, 1.0) * sweep.slide;
            crossed = crossed || geometry::first_crossing(still, moving, moved).has_value();
        }
        CHECK((may || !crossed));
    }
    CHECK(excluded > 50);
    CHECK(excluded < 550);
}

TEST_CASE("Sweeps: triangles cross at no angle if their distances from the axis exclude it") {
    Random random(12);
    int excluded = 0;
    for (int round = 0; round < 400; ++round) {
        const Bvh still(cloud(random, 2, 0.2, 1.0)), moving(cloud(random, 2, 0.2, 1.0));
        const RigidMotion frame = random_motion(random);
        const double height = random.uniform(-0.5, 0.5);
        const bool may = geometry::may_cross_at_any_angle(still, moving, frame, height);
        excluded += may ? 0 : 1;
        bool crossed = false;
        for (int i = 0; i < 90; ++i) {
            const RigidMotion turned = RigidMotion::about_y(i * pi / 45.0, Vec3{0.0, height, 0.0});
            crossed = crossed || geometry::first_crossing(still, moving, after(frame, turned)).has_value();
        }
        CHECK((may || !crossed));
    }
    CHECK(excluded > 100);
    CHECK(excluded < 390);
}

TEST_CASE("Sweeps: the free swing is that of an exact test at each degree, in every frame") {
    Random random(13);
    int blocked = 0;
    for (int round = 0; round < 30; ++round) {
        const Bvh tool(cloud(random, 20, 0.1, 0.4));
        // The parts of a model in its own frame, one of them left out.
        const RigidMotion frame = random_motion(random);
        glm::dmat4 to_assembly(frame.turn);
        to_assembly[3] = glm::dvec4(frame.shift, 1.0);
        std::vector<Bvh> parts;
        std::vector<Triangle> in_joint;
        for (std::uint32_t part = 0; part < 3; ++part) {
            std::vector<Triangle> triangles = cloud(random, 2, 0.1, 0.5, part);
            if (part != 1) in_joint.insert(in_joint.end(), triangles.begin(), triangles.end());
            for (Triangle& t : triangles) t = {frame(t.a), frame(t.b), frame(t.c), part};
            parts.emplace_back(triangles);
        }
        const geometry::Obstacles obstacles(parts, glm::inverse(to_assembly), to_assembly, {1});
        const double height = random.uniform(-0.1, 0.1);
        const geometry::FreeSwing swing = geometry::find_free_swing(obstacles, tool, height);
        const Bvh exact(in_joint);
        for (int i = 0; i < 360; ++i) {
            const double angle = to_radians(i);
            const auto inside = [&](const auto& arcs) {
                return std::any_of(arcs.begin(), arcs.end(), [&](const auto& arc) {
                    const double from = angle - 2.0 * pi * std::floor((angle - arc.from) / (2.0 * pi));
                    return from <= arc.to;
                });
            };
            const bool hit =
                geometry::first_crossing(exact, tool, RigidMotion::about_y(angle, Vec3{0.0, height, 0.0}))
                    .has_value();
            blocked += hit ? 1 : 0;
            REQUIRE(inside(swing.blocked) == hit);
            REQUIRE((hit || inside(swing.arcs)));
        }
    }
    CHECK(blocked > 500);
    CHECK(blocked < 10000);
}

}  // namespace geometry_sweeps_test
