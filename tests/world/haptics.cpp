// The world's components follow the servo's snapshot.
#include "game/world/world.hpp"

#include <doctest/doctest.h>

#include "tests/servo/support.hpp"

using namespace bolt;

namespace {

struct Bench {
    servo::Setup setup = test::two_joints();
    servo::State state = servo::initial_state(setup);
    servo::TickInput input;
    world::World world;

    Bench() {
        input.dead_man = true;
        world::add_haptics(world, state, {Vec3(0.3, 0.0, 0.1), Quat(1, 0, 0, 0)});
    }
    servo::Output tick() {
        const servo::Output output = servo::tick(setup, state, input);
        world::write_haptics(world, {state, input, output});
        return output;
    }
    // Puts the wrench on a nut, with the handle at this angle in rad.
    void put_on(std::size_t joint, double handle) {
        const servo::NutGeometry& nut = setup.nuts[joint];
        const Vec3 centre = servo::nut_centre(nut, state.joints[joint].nut.angle);
        input = test::holding(servo::Grip::wrench, test::tool_at(nut, centre, handle));
    }
};

}  // namespace

TEST_CASE("World: after each tick the components equal the servo's values bit for bit") {
    Bench bench;
    bool engaged = false;
    for (int i = 0; i < 1600; ++i) {
        bench.put_on(1, to_radians(0.05 * i));
        const servo::Output output = bench.tick();
        const world::ToolState& contact = bench.world.only<world::ToolState>();
        REQUIRE(contact.joint == output.joint);
        REQUIRE(bench.world.only<world::ConstrainedTool>().pose.position == output.constrained_tool.position);
        REQUIRE(bench.world.only<world::DeviceForce>().torque == output.torque);
        for (std::size_t j = 0; j < bench.state.joints.size(); ++j) {
            const world::Joint& joint = world::joint_at(bench.world, j);
            REQUIRE(joint.index == j);
            REQUIRE(joint.angle == bench.state.joints[j].nut.angle);
            REQUIRE(joint.clamp == bench.state.joints[j].clamp);
            REQUIRE(world::nut_centre(bench.world, bench.setup, j) ==
                    servo::nut_centre(bench.setup.nuts[j], joint.angle));
        }
        if (output.joint < 0) continue;
        engaged = true;
        const world::Joint& joint = world::joint_at(bench.world, 1);
        REQUIRE(joint.torque == output.wrench_torque);
        REQUIRE(joint.stage == output.stage);
        REQUIRE(joint.angle == output.nut_angle);
    }
    CHECK(engaged);
    CHECK(world::joint_at(bench.world, 1).torque > 0.0);
    CHECK(world::joint_at(bench.world, 0).torque == 0.0);
}

TEST_CASE("World: the hand has the input's pose and keeps the wrench's resting place") {
    Bench bench;
    const world::WorkingHand& hand = bench.world.only<world::WorkingHand>();
    for (int degrees = 0; degrees < 60 && hand.action != world::HandAction::holding; ++degrees) {
        bench.put_on(0, to_radians(static_cast<double>(degrees)));
        bench.tick();
    }
    CHECK(hand.wrench);
    CHECK(hand.action == world::HandAction::holding);
    CHECK(hand.nut == std::size_t{0});
    CHECK(hand.rest.position == Vec3(0.3, 0.0, 0.1));
    CHECK(glm::distance(hand.pose.position, bench.world.only<world::ConstrainedTool>().pose.position) < 1e-6);
    bench.input.grip = servo::Grip::none;
    bench.tick();
    CHECK_FALSE(hand.wrench);
    CHECK(hand.action == world::HandAction::resting);
    CHECK_FALSE(hand.nut);
}

TEST_CASE("World: the guiding force is reported until a nut is held") {
    Bench bench;
    bench.input.commanded_tool =
        servo::to_commanded_tool({bench.setup.nuts[0].seat + Vec3(0.02, 0.03, 0.0), Quat(1, 0, 0, 0)});
    bench.input.guided_joint = 0;
    for (int i = 0; i < 300; ++i) bench.tick();
    const world::GuidingForce& guide = bench.world.only<world::GuidingForce>();
    CHECK(guide.joint == 0);
    CHECK(glm::length(guide.force) > 0.0);
    bench.input.guided_joint = -1;
    for (int i = 0; i < 3000; ++i) bench.tick();
    CHECK(guide.joint == -1);
    CHECK(glm::length(guide.force) < 1e-9);
}
