// The head of a ratchet in the world's components.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "game/world/world.hpp"
#include "tests/servo/support.hpp"

using namespace bolt;

namespace {

constexpr double tooth = to_radians(5.0);

// A ratchet with a 12-point socket on the nut of joint 1.
struct RatchetBench {
    servo::Setup setup = test::two_joints();
    servo::State state;
    servo::TickInput input;
    world::World world;

    explicit RatchetBench(bool loosens, double sense) {
        setup.wrench.head = collision::Ring{.opening = 24.2e-3, .points = 12};
        setup.wrench.head_angle = 0.0;
        setup.wrench.ratchet.tooth_angle = tooth;
        // Below the friction of a free nut, which would otherwise turn back with the handle.
        setup.wrench.ratchet.drag = 1e-6;
        setup.wrench.ratchet.loosens = loosens;
        setup.nuts[1].sense = sense;
        state = servo::initial_state(setup);
        world::add_haptics(world, state);
    }
    // One tick with the handle at this angle, rad, positive in the direction that tightens.
    void tick(double handle, double height = 0.0) {
        const servo::NutGeometry& nut = setup.nuts[1];
        const Vec3 centre = servo::nut_centre(nut, state.joints[1].nut.angle) + height * nut.axis;
        input = test::holding(servo::Grip::wrench, test::tool_at(nut, centre, handle));
        const servo::Output output = servo::tick(setup, state, input);
        world::write_haptics(world, {state, input, output});
        world::turn_ratchet_head(world, setup, {state, input, output});
    }
    [[nodiscard]] bool engaged() const { return state.engagement.joint == 1; }
    [[nodiscard]] double head_turn() const { return world.only<world::ToolState>().head_turn; }
    // rad about the nut's axis, of a corner of the drawn socket from one of the drawn nut: −15° … 15°.
    [[nodiscard]] double misfit() const {
        const servo::NutGeometry& nut = setup.nuts[1];
        const Pose& tool = world.only<world::ConstrainedTool>().pose;
        const Quat head = tool.orientation * glm::angleAxis(head_turn(), Vec3(0, 0, 1));
        const Pose drawn = servo::nut_pose(nut, world::joint_at(world, 1).angle);
        const Vec3 corner = glm::inverse(drawn.orientation) * (head * Vec3(1, 0, 0));
        return wrap(std::atan2(corner.y, corner.x), to_radians(30.0));
    }
    [[nodiscard]] double play() const {
        return servo::half_play(setup.wrench, setup.nuts[1].across_flats, state.rounded[1]);
    }
};

}  // namespace

TEST_CASE(
    "World: the head of a ratchet stays on the nut while the handle swings, and turns with it in a pull") {
    for (const bool loosens : {false, true})
        for (const double sense : {1.0, -1.0}) {
            CAPTURE(loosens);
            CAPTURE(sense);
            RatchetBench bench(loosens, sense);
            const double forward = loosens ? -1.0 : 1.0;
            // Far enough up its thread to be loosened.
            if (loosens) bench.state.joints[1].nut.angle = 3.0;
            double handle = to_radians(7.0);
            for (int i = 0; i < 40; ++i) bench.tick(handle);
            REQUIRE(bench.engaged());
            CHECK(std::abs(bench.misfit()) <= bench.play() + 1e-9);
            double before = bench.head_turn();
            const auto swing = [&](double by) {
                const double first = bench.head_turn();
                for (int i = 0; i < 800; ++i) {
                    bench.tick(handle += by / 800);
                    REQUIRE(bench.engaged());
                    REQUIRE(std::abs(bench.misfit()) <= bench.play() + 1e-9);
                    REQUIRE(std::abs(bench.head_turn() - before) < to_radians(1.0));  // never jumps
                    before = bench.head_turn();
                }
                return bench.head_turn() - first;
            };
            // Two strokes: the pull turns head and handle together; on the way back only the handle moves.
            for (int stroke = 0; stroke < 2; ++stroke) {
                const double nut = bench.state.joints[1].nut.angle;
                const double pulled = swing(forward * to_radians(60.0));
                CHECK(std::abs(pulled) <= tooth + 4.0 * bench.play());
                CHECK(forward * (bench.state.joints[1].nut.angle - nut) > to_radians(45.0));
                const double returned = swing(-forward * to_radians(60.0));
                CHECK(returned == doctest::Approx(-sense * forward * to_radians(60.0)).epsilon(0.1));
            }
        }
}

TEST_CASE("World: the head of a ratchet keeps its turn off the nut and loses it when the tool is put down") {
    RatchetBench bench(false, 1.0);
    double handle = 0.0;
    for (int i = 0; i < 20; ++i) bench.tick(handle);
    REQUIRE(bench.engaged());
    for (int i = 0; i < 500; ++i) bench.tick(handle -= to_radians(0.05));
    const double turned = bench.head_turn();
    REQUIRE(std::abs(turned) > to_radians(15.0));
    for (int i = 0; i < 50; ++i) bench.tick(handle, 0.08);
    CHECK_FALSE(bench.engaged());
    CHECK(bench.head_turn() == turned);
    double before = turned, fastest = 0.0;
    for (int i = 0; i < 40; ++i) {
        bench.tick(handle += to_radians(0.1));
        fastest = std::max(fastest, std::abs(bench.head_turn() - before));
        before = bench.head_turn();
    }
    REQUIRE(bench.engaged());
    CHECK(fastest <= 10.0 * bench.setup.dt + 1e-12);
    CHECK(std::abs(bench.head_turn() - turned) <= to_radians(19.0) + 1e-9);
    CHECK(std::abs(bench.misfit()) <= bench.play() + 1e-9);
    bench.input.grip = servo::Grip::none;
    const servo::Output output = servo::tick(bench.setup, bench.state, bench.input);
    world::turn_ratchet_head(bench.world, bench.setup, {bench.state, bench.input, output});
    CHECK(bench.head_turn() == 0.0);
}

TEST_CASE("World: a tool without a ratchet has no head that turns") {
    RatchetBench bench(false, 1.0);
    bench.setup.wrench.ratchet.tooth_angle = 0.0;
    for (int i = 0; i < 100; ++i) {
        bench.tick(to_radians(0.1 * i));
        REQUIRE(bench.head_turn() == 0.0);
    }
}
