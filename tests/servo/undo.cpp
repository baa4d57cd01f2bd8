// Nuts that go back to where they were: an undo, as an input of the tick like any other.
#include <doctest/doctest.h>

#include "haptics/servo/tick.hpp"
#include "tests/servo/support.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

struct Bench {
    Setup setup = test::two_joints();
    State state = initial_state(setup);

    // A hand that is far from everything.
    [[nodiscard]] Input away(std::uint8_t undo) const {
        Input input = test::holding(Grip::none, test::tool_at(setup.nuts[0], Vec3(0.0, 1.0, 1.0), 0.0));
        input.undo = undo;
        return input;
    }
    Output ask(std::uint8_t undo) { return tick(setup, state, away(undo)); }
    // Nut 0 by so many turns, by machine.
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
    bench.ask(save_checkpoint);
    const std::vector<joint::JointState> first = bench.state.joints;
    bench.turn(1.0);
    bench.ask(save_checkpoint);
    const double second = bench.state.joints[0].nut.angle;
    bench.turn(1.5);
    CHECK(bench.state.joints[0].nut.angle > second + 9.0);
    CHECK(bench.ask(1).undone == 1);
    CHECK(bench.state.joints[0].nut.angle == second);
    CHECK(bench.ask(1).undone == 1);  // there already: again
    CHECK(bench.state.joints[0].nut.angle == second);
    CHECK(bench.ask(2).undone == 2);
    CHECK(bench.state.joints[0].nut.angle == first[0].nut.angle);
    CHECK(bench.state.joints[0].clamp == first[0].clamp);
    CHECK(bench.ask(2).undone == 0);  // there is but one mark now
    CHECK(bench.ask(0).undone == 0);
}

TEST_CASE("Undo: no effect without a checkpoint or beyond the stored ones") {
    Bench bench;
    bench.turn(1.0);
    const double angle = bench.state.joints[0].nut.angle;
    for (const int undo : {1, 2, 8, 9, 254}) CHECK(bench.ask(static_cast<std::uint8_t>(undo)).undone == 0);
    CHECK(bench.state.joints[0].nut.angle == angle);
    for (int i = 0; i < 3 * max_checkpoints; ++i) {
        bench.ask(save_checkpoint);
        bench.turn(0.05);
    }
    CHECK(bench.ask(max_checkpoints + 1).undone == 0);
    CHECK(bench.ask(max_checkpoints).undone == max_checkpoints);
    CHECK(bench.state.joints[0].nut.angle > angle);
}

TEST_CASE("Undo: not while a nut is held or the tool is beside it") {
    Bench bench;
    bench.ask(save_checkpoint);
    bench.turn(1.0);
    const NutGeometry& nut = bench.setup.nuts[0];
    const Vec3 at = nut_centre(nut, bench.state.joints[0].nut.angle);
    Input input = test::holding(Grip::fingers, test::tool_at(nut, at, 0.0));
    Output output;
    for (int i = 0; i < 50; ++i) output = tick(bench.setup, bench.state, input);
    REQUIRE(output.joint == 0);
    input.undo = 1;
    CHECK(tick(bench.setup, bench.state, input).undone == 0);
    Input beside = test::holding(Grip::none, test::tool_at(nut, at + 0.1 * nut.axis, 0.0));
    beside.undo = 1;
    CHECK(tick(bench.setup, bench.state, beside).undone == 0);
    CHECK(bench.ask(1).undone == 1);
}

TEST_CASE("Undo: saving and restoring allocate nothing") {
    Bench bench;
    const test::Forbidden seen = test::forbidden_in([&] {
        for (int i = 0; i < 20; ++i) {
            bench.ask(save_checkpoint);
            bench.ask(1);
        }
    });
    CHECK(seen.all() == 0);
}
