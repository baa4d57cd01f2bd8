// The click-type torque wrench: its set torque is an input, the deviation from it belongs to the tool, and
// the click is rendered within the device's limits.
#include <doctest/doctest.h>

#include "tests/servo/support.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

constexpr float set_torque = 60.0F;

Setup with_torque_wrench(double deviation = 0.0, double dt = 1e-3) {
    Setup setup = test::two_joints();
    setup.dt = dt;
    setup.wrench.click.swing = to_radians(4.0);
    setup.wrench.deviation = deviation;
    return setup;
}

// The wrench on nut 0, with its handle at the hand's angle.
struct Bench {
    Setup setup;
    State state;
    double handle = 0.0, scale = set_torque;
    Grip grip = Grip::wrench;
    Output last;

    explicit Bench(Setup made) : setup(std::move(made)), state(initial_state(setup)) {}
    Output hold(double angle) {
        handle = angle;
        const NutGeometry& nut = setup.nuts[0];
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        TickInput input = test::holding(grip, test::tool_at(nut, at, setup.wrench.head_angle + handle));
        input.set_torque = static_cast<float>(scale);
        return last = tick(setup, state, input);
    }
    // Turns the handle until the wrench clicks, at most by `at_most` (rad). Returns the greatest torque, N·m.
    double pull(double at_most, double speed = 1.0) {
        double greatest = 0.0;
        const double end = handle + at_most;
        while (handle < end) {
            hold(handle + speed * setup.dt);
            greatest = std::max(greatest, last.wrench_torque);
            if (last.clicked) break;
        }
        return greatest;
    }
};

}  // namespace

TEST_CASE("Click: the wrench clicks at its set torque plus its deviation, at any servo rate") {
    for (const double dt : {1e-3, 2.5e-4})
        for (const double deviation : {-0.04, 0.0, 0.03}) {
            Bench bench(with_torque_wrench(deviation, dt));
            bench.hold(0.0);
            const double greatest = bench.pull(60.0);
            CHECK(bench.last.clicked);
            const double trips = static_cast<double>(set_torque) * (1.0 + deviation);
            CHECK(greatest <= trips * (1.0 + 1e-9));
            CHECK(greatest > 0.95 * trips);
            int clicks = 0;
            for (int i = 0; i < 200; ++i) clicks += bench.hold(bench.handle).clicked ? 1 : 0;
            CHECK(clicks == 0);
            CHECK(bench.last.wrench_torque < 0.55 * trips);
        }
}

TEST_CASE("Click: with an adaptor the nut gets more than the scale says") {
    Setup setup = with_torque_wrench(0.02);
    setup.wrench.adaptor_ratio = joint::adaptor_ratio(0.4, 0.06);
    Bench bench(setup);
    bench.hold(0.0);
    const double greatest = bench.pull(60.0);
    CHECK(bench.last.clicked);
    const double trips = static_cast<double>(set_torque) * 1.15 * 1.02;  // (400 + 60) / 400
    CHECK(greatest <= trips * (1.0 + 1e-9));
    CHECK(greatest > 0.95 * trips);
}

TEST_CASE("Click: none without a set torque, with a plain wrench or with fingers") {
    SUBCASE("no setting") {
        Bench bench(with_torque_wrench());
        bench.scale = 0.0;
        CHECK(bench.pull(40.0) > 1.5 * static_cast<double>(set_torque));
    }
    SUBCASE("a set torque of NaN") {
        Bench bench(with_torque_wrench());
        bench.scale = std::numeric_limits<double>::quiet_NaN();
        CHECK(bench.pull(40.0) > 1.5 * static_cast<double>(set_torque));
    }
    SUBCASE("a plain wrench") {
        Bench bench(test::two_joints());
        CHECK(bench.pull(40.0) > 1.5 * static_cast<double>(set_torque));
    }
    SUBCASE("fingers") {
        Bench bench(with_torque_wrench());
        bench.grip = Grip::fingers;
        bench.scale = 0.01;
        bench.pull(20.0);
        CHECK(bench.last.joint == 0);
        CHECK_FALSE(bench.last.clicked);
    }
}

TEST_CASE("Click: a set torque changed after the click has no effect until the wrench is released") {
    Bench turned(with_torque_wrench()), left(with_torque_wrench());
    for (Bench* bench : {&turned, &left}) {
        bench->hold(0.0);
        bench->pull(60.0);
        REQUIRE(bench->last.clicked);
    }
    turned.scale = 1.0;
    for (int i = 0; i < 100; ++i) {
        const double angle = turned.handle + 2e-4;
        REQUIRE(turned.hold(angle).wrench_torque == left.hold(angle).wrench_torque);
    }
}

TEST_CASE("Click: the wrench is armed again once it left the nut") {
    Bench bench(with_torque_wrench());
    bench.hold(0.0);
    bench.pull(60.0);
    REQUIRE(bench.last.clicked);
    bench.hold(bench.handle);
    CHECK(bench.state.engagement.swung > 0.0);
    bench.grip = Grip::none;
    bench.hold(bench.handle);
    CHECK(bench.state.engagement.swung == 0.0);
}

TEST_CASE("Click: the device's torque drops briefly, within the slew rates") {
    for (const double dt : {1e-3, 2.5e-4}) {
        Bench bench(with_torque_wrench(0.0, dt));
        for (int i = 0; i < static_cast<int>(1.0 / dt); ++i) bench.hold(0.0);
        bench.pull(60.0);
        REQUIRE(bench.last.clicked);
        const double before = glm::length(bench.last.torque);
        REQUIRE(before > 0.1);
        for (int i = 0; i < static_cast<int>(0.1 / dt); ++i) {
            const Vec3 felt = bench.last.torque;
            bench.hold(bench.handle);
            // The click itself is slower than the slew rate permits.
            REQUIRE(glm::length(bench.last.torque - felt) <= 0.9 * bench.setup.limits.torque_slew_rate * dt);
        }
        CHECK(glm::length(bench.last.torque) < 0.6 * before);
    }
}

TEST_CASE("Click: each wrench has a constant deviation within its accuracy") {
    const joint::JointDesign design = test::m16_flange_joint();
    SetupDescription description;
    description.joints = {&design, 1};
    description.tool.head = collision::make_jaw(24.2e-3, 0.0);
    description.tool.handle_length = 0.23;
    description.tool.click_swing = to_radians(4.0);
    description.tool.click_accuracy = 0.04;
    double least = 1.0, most = -1.0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        description.seed = seed;
        const double deviation = make_setup(description).wrench.deviation;
        CHECK(make_setup(description).wrench.deviation == deviation);
        least = std::min(least, deviation);
        most = std::max(most, deviation);
    }
    CHECK(least >= -0.04);
    CHECK(least < -0.035);
    CHECK(most <= 0.04);
    CHECK(most > 0.035);
}

TEST_CASE("Click: ticks allocate nothing and give the same bits") {
    const auto run = [] {
        Bench bench(with_torque_wrench());
        bench.hold(0.0);
        const test::Forbidden in_ticks = test::forbidden_in([&] {
            bench.pull(60.0);
            bench.pull(0.3);
        });
        CHECK(in_ticks.all() == 0);
        return std::pair(bench.last.wrench_torque, bench.state.engagement.swung);
    };
    CHECK(run() == run());
}
