#include "haptics/collision/world.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "haptics/collision/narrow_phase.hpp"
#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace contact_test;

namespace {

struct PlateAndBlocks {
    ContactMesh block = box(Vec3(-4.0, -4.0, -4.0) * mm, Vec3(4.0, 4.0, 4.0) * mm).mesh();
    ContactMesh plate = box(Vec3(-30.0, -2.0, -30.0) * mm, Vec3(30.0, 0.0, 30.0) * mm).mesh();
    std::vector<Pose> poses;

    PlateAndBlocks() {
        Random random(31);
        for (int i = 0; i < 5; ++i)
            poses.push_back(
                {Vec3(-24.0 + 12.0 * i, 6.0, 0.0) * mm, rotation(Vec3(0.0, random.uniform(0.0, 1.0), 0.0))});
    }
    [[nodiscard]] CollisionWorld world(bool move) const {
        std::vector<Obstacle> obstacles{{ObstacleId::fixed(100), &plate, {}, false}};
        for (std::size_t i = 0; i < poses.size(); ++i)
            obstacles.push_back({ObstacleId::nut(i), &block, poses[i], move});
        return make_world(obstacles).value();
    }
};

}  // namespace

TEST_CASE("Collision world: moving bodies give the distances of fixed ones within float precision") {
    const PlateAndBlocks layout;
    const CollisionWorld still = layout.world(false);
    const CollisionWorld moving = layout.world(true);
    CHECK(still.bodies.size() == 1);
    CHECK(moving.bodies.size() == 6);
    CHECK(moving.shapes.size() == 2);  // the plate, and one that five bodies share
    const std::vector<ContactMesh> parts{wrench().mesh()};
    const ToolShape tool = make_tool(parts).value();
    NarrowPhaseState a = make_narrow_phase(still, tool);
    NarrowPhaseState b = make_narrow_phase(moving, tool);
    Random random(32);
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        const Pose pose{
            Vec3(random.uniform(-30.0, 30.0), random.uniform(2.0, 25.0), random.uniform(-12.0, 12.0)) * mm,
            random_turn(random)};
        std::array<Contact, 24> of_still;
        std::array<Contact, 24> of_moving;
        const ContactQueryResult x = find_contacts(still, tool, pose, 1.0 * mm, a, of_still);
        const ContactQueryResult y = find_contacts(moving, tool, pose, 1.0 * mm, b, of_moving);
        REQUIRE((x.count > 0) == (y.count > 0));
        if (x.count == 0) continue;
        ++touching;
        REQUIRE(std::abs(of_still[0].distance - of_moving[0].distance) < 1e-6);
        REQUIRE(of_still[0].obstacle == of_moving[0].obstacle);
    }
    CHECK(touching > 200);
}

TEST_CASE("Collision world: contacts follow a moving body, and a disabled body has none") {
    const PlateAndBlocks layout;
    CollisionWorld world = layout.world(true);
    const std::vector<ContactMesh> parts{box(Vec3(-1.0) * mm, Vec3(1.0) * mm).mesh()};
    const ToolShape tool = make_tool(parts).value();
    NarrowPhaseState state = make_narrow_phase(world, tool);
    const std::size_t body = find_body(world, ObstacleId::nut(3)).value();
    CHECK_FALSE(find_body(world, ObstacleId::nut(100)));  // 100 is a fixed obstacle
    CHECK_FALSE(find_body(world, ObstacleId::nut(77)));
    std::array<Contact, 16> contacts;
    const Pose above{layout.poses[3].position + Vec3(0.0, 6.0, 0.0) * mm, Quat(1.0, 0.0, 0.0, 0.0)};
    for (int i = 0; i < 300; ++i) {
        const double down = 0.01 * i * mm;
        world.bodies[body].pose.position = layout.poses[3].position - Vec3(0.0, down, 0.0);
        const ContactQueryResult found = find_contacts(world, tool, above, 1.5 * mm, state, contacts);
        const double gap = 1.0 * mm + down;
        REQUIRE((found.count > 0) == (gap <= 1.5 * mm));
        if (found.count > 0) {
            CHECK(contacts[0].distance == doctest::Approx(gap).epsilon(1e-3));
            CHECK(contacts[0].obstacle == ObstacleId::nut(3));
        }
    }
    world.bodies[body].pose = layout.poses[3];
    CHECK(find_contacts(world, tool, above, 1.5 * mm, state, contacts).count > 0);
    world.bodies[body].enabled = false;
    CHECK(find_contacts(world, tool, above, 1.5 * mm, state, contacts).count == 0);
    world.bodies[body].enabled = true;
    CHECK(find_contacts(world, tool, above, 1.5 * mm, state, contacts).count > 0);
}

TEST_CASE("Collision world: a line of sight is occluded by obstacles at their current poses") {
    const PlateAndBlocks layout;
    CollisionWorld world = layout.world(true);
    const Vec3 left = Vec3(-100.0, 6.0, 0.0) * mm;
    const Vec3 right = Vec3(100.0, 6.0, 0.0) * mm;
    CHECK(occluded(world, left, right));
    CHECK_FALSE(occluded(world, left + Vec3(0.0, 5.0, 0.0) * mm, right + Vec3(0.0, 5.0, 0.0) * mm));
    CHECK(occluded(world, Vec3(0.0, 1.0, 0.0) * mm, Vec3(0.0, -3.0, 0.0) * mm));
    for (std::size_t i = 0; i < 5; ++i)
        world.bodies[find_body(world, ObstacleId::nut(i)).value()].enabled = i == 2;
    CHECK(occluded(world, left, right));
    CHECK_FALSE(occluded(world, left, right, find_body(world, ObstacleId::nut(2))));
    world.bodies[find_body(world, ObstacleId::nut(2)).value()].pose.position.z += 20.0 * mm;
    CHECK_FALSE(occluded(world, left, right));
}

TEST_CASE("Collision world: deep inside a solid the contact normal points to the nearest surface") {
    const ContactMesh block = box(Vec3(-20.0) * mm, Vec3(20.0) * mm).mesh();
    const Obstacle obstacle{ObstacleId::fixed(1), &block, {}, false};
    const CollisionWorld world = make_world({&obstacle, 1}).value();
    CHECK(signed_distance(world, Vec3(12.0, 1.0, 3.0) * mm) == doctest::Approx(-8.0 * mm));
    const std::vector<ContactMesh> parts{box(Vec3(-1.0) * mm, Vec3(1.0) * mm).mesh()};
    const ToolShape tool = make_tool(parts).value();
    NarrowPhaseState state = make_narrow_phase(world, tool);
    std::array<Contact, 8> contacts;
    const ContactQueryResult found = find_contacts(
        world, tool, {Vec3(12.0, 1.0, 3.0) * mm, Quat(1.0, 0.0, 0.0, 0.0)}, 0.5 * mm, state, contacts);
    REQUIRE(found.count > 0);
    CHECK(contacts[0].distance == doctest::Approx(-9.0 * mm));
    CHECK(glm::length(contacts[0].normal - Vec3(1.0, 0.0, 0.0)) < 1e-9);
}

TEST_CASE("Collision world: a point inside one of two touching parts is inside") {
    const ContactMesh under = box(Vec3(-10.0, -10.0, -10.0) * mm, Vec3(10.0, 0.0, 10.0) * mm).mesh();
    const ContactMesh over = box(Vec3(-5.0, 0.0, -5.0) * mm, Vec3(5.0, 4.0, 5.0) * mm).mesh();
    for (const bool over_first : {false, true}) {
        const std::vector<Obstacle> obstacles{{ObstacleId::fixed(1), over_first ? &over : &under, {}, false},
                                              {ObstacleId::fixed(2), over_first ? &under : &over, {}, false}};
        const CollisionWorld world = make_world(obstacles).value();
        CHECK(signed_distance(world, Vec3(0.0, -0.5, 0.0) * mm) < 0.0);
        CHECK(signed_distance(world, Vec3(0.0, 0.5, 0.0) * mm) < 0.0);
        CHECK(signed_distance(world, Vec3(7.0, 0.5, 0.0) * mm) > 0.0);
    }
}

TEST_CASE("Collision world: an invalid obstacle or tool is an error") {
    const ContactMesh block = box(Vec3(0.0), Vec3(1.0)).mesh();
    const std::vector<Obstacle> without{{ObstacleId::fixed(1), nullptr, {}, false}};
    CHECK_FALSE(make_world(without));
    const ContactMesh empty;
    const std::vector<Obstacle> nothing{{ObstacleId::nut(1), &empty, {}, true}};
    CHECK_FALSE(make_world(nothing));
    CHECK(make_world({}));  // an empty world is valid
    CHECK_FALSE(make_tool({}));
    Triangles open;
    open.triangle(Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 1.0, 0.0));
    const ContactMesh sheet = open.mesh();
    CHECK_FALSE(make_tool({&sheet, 1}));
    ToolOptions options;
    options.samples.max_piece = 0.0;
    CHECK_FALSE(make_tool({&block, 1}, options));
}
