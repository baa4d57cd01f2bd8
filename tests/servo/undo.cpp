// Undo: an input of the tick that restores the nuts of a checkpoint.
#include <doctest/doctest.h>

#include "haptics/servo/tick.hpp"
#include "tests/servo/support.hpp"
#include "tests/support/forbidden.hpp"

namespace servo_undo_test {

using namespace bolt;
using namespace bolt::servo;

namespace {

struct Bench {
    Setup setup = test::two_joints();
    State state = initial_state(setup);

    // Input of a hand far from all nuts.
    [[nodiscard]] TickInput away(std::uint8_t undo) const {
        TickInput input = test::holding(Grip::none, test::tool_at(setup.nuts[0], Vec3(0.0, 1.0, 1.0), 0.0));
        input.checkpoint_action = undo;
        return input;
    }
    Output step(std::uint8_t undo) { return tick(setup, state, away(undo)); }
    // Turns nut 0 kinematically.
    void turn(double turns) {
        const double step = to_radians(0.5), end = state.joints[0].nut.angle + 2.0 * pi * turns;
        while (state.joints[0].nut.angle < end)
            joint::turn_nut(setup.group, state.joints, 0, state.joints[0].nut.angle + step, 1.0, setup.dt);
        state.joints[0].nut.speed = 0.0;
    }
};

}  // namespace

TEST_CASE("Undo: a checkpoint is restored bit for bit, any number of times") {
    Bench bench;
    bench.step(save_checkpoint);
    const std::vector<joint::JointState> first = bench.state.joints;
    bench.turn(1.0);
    bench.step(save_checkpoint);
    const double second = bench.state.joints[0].nut.angle;
    bench.turn(1.5);
    CHECK(bench.state.joints[0].nut.angle > second + 9.0);
    CHECK(bench.step(1).undone == 1);
    CHECK(bench.state.joints[0].nut.angle == second);
    CHECK(bench.step(1).undone == 1);  // restored once more
    CHECK(bench.state.joints[0].nut.angle == second);
    CHECK(bench.step(2).undone == 2);
    CHECK(bench.state.joints[0].nut.angle == first[0].nut.angle);
    CHECK(bench.state.joints[0].clamp == first[0].clamp);
    CHECK(bench.step(2).undone == 0);  // only one checkpoint is left
    CHECK(bench.step(0).undone == 0);
}

TEST_CASE("Undo: no effect without a checkpoint or beyond the stored ones") {
    Bench bench;
    bench.turn(1.0);
    const double angle = bench.state.joints[0].nut.angle;
    for (const int undo : {1, 2, 8, 9, 254}) CHECK(bench.step(static_cast<std::uint8_t>(undo)).undone == 0);
    CHECK(bench.state.joints[0].nut.angle == angle);
    for (int i = 0; i < 3 * max_checkpoints; ++i) {
        bench.step(save_checkpoint);
        bench.turn(0.05);
    }
    CHECK(bench.step(max_checkpoints + 1).undone == 0);
    CHECK(bench.step(max_checkpoints).undone == max_checkpoints);
    CHECK(bench.state.joints[0].nut.angle > angle);
}

TEST_CASE("Undo: not while a nut is held or the tool is beside it") {
    Bench bench;
    bench.step(save_checkpoint);
    bench.turn(1.0);
    const NutGeometry& nut = bench.setup.nuts[0];
    const Vec3 at = nut_centre(nut, bench.state.joints[0].nut.angle);
    TickInput input = test::holding(Grip::fingers, test::tool_at(nut, at, 0.0));
    Output output;
    for (int i = 0; i < 50; ++i) output = tick(bench.setup, bench.state, input);
    REQUIRE(output.joint == 0);
    input.checkpoint_action = 1;
    CHECK(tick(bench.setup, bench.state, input).undone == 0);
    TickInput beside = test::holding(Grip::none, test::tool_at(nut, at + 0.1 * nut.axis, 0.0));
    beside.checkpoint_action = 1;
    CHECK(tick(bench.setup, bench.state, beside).undone == 0);
    CHECK(bench.step(1).undone == 1);
}

TEST_CASE("Undo: saving and restoring allocate nothing") {
    Bench bench;
    const test::Forbidden found = test::forbidden_in([&] {
        for (int i = 0; i < 20; ++i) {
            bench.step(save_checkpoint);
            bench.step(1);
        }
    });
    CHECK(found.all() == 0);
}

}  // namespace servo_undo_test
