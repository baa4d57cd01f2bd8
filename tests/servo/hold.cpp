// Forces on an engaged tool besides the joint's torque, the conditions of its release, and the state after a
// release.
#include <doctest/doctest.h>

#include <initializer_list>

#include "tests/servo/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

// Limits that let a force appear within one tick: full strength at once, a steep slew, and no damping, as the
// poses of these tests jump.
force::OutputLimits at_once() {
    force::OutputLimits limits;
    limits.ramp_up = 1e-3;
    limits.force_slew_rate = 1e6;
    limits.torque_slew_rate = 1e6;
    limits.damping = limits.angular_damping = 0.0;
    return limits;
}

CommandedTool tilted(const CommandedTool& sample, const Vec3& about, double angle) {
    const Quat q(static_cast<double>(sample.orientation[0]), static_cast<double>(sample.orientation[1]),
                 static_cast<double>(sample.orientation[2]), static_cast<double>(sample.orientation[3]));
    const Quat turned = glm::angleAxis(angle, about) * q;
    CommandedTool out = sample;
    out.orientation[0] = static_cast<float>(turned.w);
    out.orientation[1] = static_cast<float>(turned.x);
    out.orientation[2] = static_cast<float>(turned.y);
    out.orientation[3] = static_cast<float>(turned.z);
    return out;
}

struct Held {
    Setup setup = test::two_joints(at_once());
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    Vec3 centre = nut_centre(nut, 0.0);

    Output step(Grip grip, const CommandedTool& sample) {
        return tick(setup, state, test::holding(grip, sample));
    }
    // Handle angle at which the jaw is aligned with the flats of the nut at angle 0.
    [[nodiscard]] double fits(bool flipped = false) const {
        return flipped ? -setup.wrench.head_angle : setup.wrench.head_angle;
    }
    [[nodiscard]] CommandedTool at(const Vec3& offset, bool flipped = false) const {
        return test::tool_at(nut, centre + offset, fits(flipped), flipped);
    }
};

}  // namespace

TEST_CASE("Hold: an engaged tool is pulled back to the nut's centre with 1 N per millimetre") {
    Held held;
    REQUIRE(held.step(Grip::wrench, held.at(Vec3(0.0))).joint == 0);
    const Vec3 places[] = {0.005 * held.nut.e1, -0.004 * held.nut.e2, 0.003 * held.nut.axis};
    for (const Vec3& offset : places) {
        const Output output = held.step(Grip::wrench, held.at(offset));
        REQUIRE(output.joint == 0);
        CHECK(output.wrench_torque == 0.0);
        CHECK(glm::length(output.force + 1000.0 * offset) < 1e-3);
    }
}

TEST_CASE("Hold: engaged off centre, the pull starts at zero and settles with a time constant of 50 ms") {
    Held held;
    const Vec3 offset = 1e-3 * held.nut.e1;
    for (int n = 0; n <= 1000; ++n) {
        const Output output = held.step(Grip::wrench, held.at(offset));
        REQUIRE(output.joint == 0);
        const double settled = 1.0 - std::pow(1.0 - 1e-3 / 0.05, n);
        REQUIRE(glm::dot(output.force, held.nut.e1) == doctest::Approx(-settled).epsilon(1e-3));
    }
    CHECK(glm::length(held.state.engagement.offset_at_engagement) < 1e-9);
}

TEST_CASE("Hold: a tilted wrench is turned square to the bolt, upright and flipped") {
    for (const bool flipped : {false, true}) {
        for (const double degrees : {-10.0, 10.0}) {
            CAPTURE(flipped);
            CAPTURE(degrees);
            Held held;
            const CommandedTool square_on = held.at(Vec3(0.0), flipped);
            REQUIRE(held.step(Grip::wrench, square_on).joint == 0);
            const Vec3 about = tool_pose(square_on).handle;
            const double tilt = to_radians(degrees);
            const Output output = held.step(Grip::wrench, tilted(square_on, about, tilt));
            REQUIRE(output.joint == 0);
            REQUIRE(output.wrench_torque == 0.0);
            CHECK(glm::length(output.torque + held.setup.hold_torsion * std::sin(tilt) * about) < 1e-4);
        }
    }
}

TEST_CASE("Hold: 0.3 of the width sideways or 0.6 of the height along the axis releases the nut") {
    const struct {
        bool sideways;
        double share;
        bool holds;
    } cases[] = {{true, 0.29, true}, {true, 0.31, false}, {false, 0.59, true}, {false, 0.61, false}};
    for (const auto& c : cases) {
        for (const double sign : {-1.0, 1.0}) {
            CAPTURE(c.share);
            Held held;
            REQUIRE(held.step(Grip::wrench, held.at(Vec3(0.0))).joint == 0);
            const Vec3 offset = c.sideways ? c.share * held.nut.across_flats * held.nut.e2
                                           : c.share * held.nut.height * held.nut.axis;
            CHECK((held.step(Grip::wrench, held.at(sign * offset)).joint == 0) == c.holds);
        }
    }
}

TEST_CASE(
    "Hold: a wrench tilted by more than 30 degrees is released; fingers when the handle nears the axis") {
    for (const double degrees : {29.0, 31.0}) {
        Held held;
        const CommandedTool square_on = held.at(Vec3(0.0));
        REQUIRE(held.step(Grip::wrench, square_on).joint == 0);
        const Vec3 about = tool_pose(square_on).handle;
        const Output output = held.step(Grip::wrench, tilted(square_on, about, to_radians(degrees)));
        CHECK((output.joint == 0) == (degrees < 30.0));
        CHECK(held.state.joints[0].nut.angle == 0.0);
    }
    for (const double degrees : {52.0, 55.0}) {  // the limit is 0.8, the cosine of 36.9 degrees to the axis
        Held held;
        const CommandedTool square_on = held.at(Vec3(0.0));
        REQUIRE(held.step(Grip::fingers, square_on).joint == 0);
        const ToolPose tool = tool_pose(square_on);
        const Vec3 about = glm::cross(tool.handle, tool.normal);
        const Output output = held.step(Grip::fingers, tilted(square_on, about, to_radians(degrees)));
        CHECK((output.joint == 0) == (degrees < 53.0));
        CHECK(held.state.joints[0].nut.angle == 0.0);
    }
}

TEST_CASE("Hold: an angle that changes faster than any hand releases the nut and does not turn it") {
    for (const Grip grip : {Grip::fingers, Grip::wrench}) {
        for (const double leap : {0.33, 0.37, -0.37, 3.0}) {
            CAPTURE(leap);
            Held held;
            REQUIRE(held.step(grip, held.at(Vec3(0.0))).joint == 0);
            const CommandedTool there = test::tool_at(held.nut, held.centre, held.fits() + leap);
            const Output output = held.step(grip, there);
            CHECK((output.joint == 0) == (leap == 0.33));
            if (leap == 0.33) {
                CHECK(held.state.joints[0].nut.angle > 0.1);
            } else {
                for (int i = 0; i < 20; ++i) held.step(grip, there);
                CHECK(held.state.joints[0].nut.angle == 0.0);
            }
        }
    }
}

TEST_CASE("Servo: an empty hand is guided to the nut's centre with k over the distance") {
    CHECK(Held().setup.guiding.max_force == 3.0);
    for (std::int16_t guide = 0; guide < 2; ++guide) {
        Held held;
        const NutGeometry& nut = held.setup.nuts[static_cast<std::size_t>(guide)];
        const Vec3 away = 0.1 * nut.axis + 0.01 * nut.e2;
        TickInput input = test::holding(Grip::none, test::tool_at(nut, nut_centre(nut, 0.0) + away, 0.0));
        input.guided_joint = guide;
        Output output;
        for (int i = 0; i < 250; ++i)
            output = tick(held.setup, held.state, input);  // the guiding force ramps up
        const double d = glm::length(away);
        CHECK(output.joint == -1);
        CHECK(glm::length(output.force + away / d * (held.setup.guiding.gain / d)) < 1e-5);
        CHECK(glm::length(output.torque) == 0.0);
    }
}

TEST_CASE("Servo: at the largest torque wrench and wrists yield 2.5 degrees") {
    const Setup setup = test::two_joints();
    CHECK(to_degrees(210.0 / setup.wrench.stiffness) == doctest::Approx(2.5).epsilon(1e-12));
}

TEST_CASE("Fingers: after slipping at the seat they unload at once when the hand turns back") {
    Held held;
    const double limit = held.setup.finger_torque(held.nut);
    CHECK(limit == doctest::Approx(0.5 * 65.0 * 0.024));
    double hand = 0.0;
    const auto turn_by = [&](double by) {
        hand += by;
        const Vec3 at = nut_centre(held.nut, held.state.joints[0].nut.angle);
        return held.step(Grip::fingers, test::tool_at(held.nut, at, hand));
    };
    Output output;
    for (int i = 0; i < 3000; ++i) output = turn_by(3e-3);  // 9 rad, beyond the seat at 2 pi
    REQUIRE(output.wrench_torque == doctest::Approx(limit).epsilon(1e-3));
    const double stands_at = held.state.joints[0].nut.angle;
    for (int i = 1; i <= 20; ++i) {
        output = turn_by(-3e-3);
        REQUIRE(output.wrench_torque ==
                doctest::Approx(limit - held.setup.finger_stiffness * 3e-3 * i).epsilon(0.01));
    }
    CHECK(held.state.joints[0].nut.angle == stands_at);
}

TEST_CASE("Servo: a NaN pose at 40 kN releases the nut, which stays, and the torque only falls") {
    Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    double angle = setup.wrench.head_angle;
    Output output;
    for (int i = 0; i < 60'000 && output.clamp < 40e3; ++i) {
        angle += 1e-3;
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        output = tick(setup, state, test::holding(Grip::wrench, test::tool_at(nut, at, angle)));
    }
    REQUIRE(output.clamp >= 40e3);
    REQUIRE(glm::length(output.torque) > 0.5);
    const double stands_at = state.joints[0].nut.angle;
    TickInput lost = test::holding(Grip::wrench, test::tool_at(nut, Vec3(0.0), angle));
    lost.commanded_tool.position[1] = std::nanf("");
    double last = output.torque.y;
    for (int i = 0; i < 200; ++i) {
        output = tick(setup, state, lost);
        REQUIRE(output.joint == -1);
        REQUIRE(output.wrench_torque == 0.0);
        REQUIRE(output.torque.y >= 0.0);
        REQUIRE(output.torque.y <= last);
        REQUIRE(state.joints[0].nut.angle == stands_at);
        REQUIRE(state.joints[0].nut.speed == 0.0);
        last = output.torque.y;
    }
    CHECK(glm::length(output.torque) == 0.0);
    CHECK(glm::length(output.force) == 0.0);
}

TEST_CASE("Servo: an invalid sample is not taken for a hand at the origin") {
    for (const bool engaged_before : {true, false}) {
        Held held;  // the first seat is at the origin, so a default pose would be within reach of the fingers
        const CommandedTool there = test::tool_at(held.nut, held.centre, 0.0);
        if (engaged_before) REQUIRE(held.step(Grip::fingers, there).joint == 0);
        CommandedTool lost = there;
        lost.position[0] = std::nanf("");
        CHECK(held.step(Grip::fingers, lost).joint == -1);
        CHECK(held.step(Grip::fingers, lost).joint == -1);
        CommandedTool without_rotation = there;
        for (float& q : without_rotation.orientation) q = 0.0F;
        CHECK(held.step(Grip::fingers, without_rotation).joint == -1);
        CHECK(held.step(Grip::fingers, there).joint == 0);
    }
}

TEST_CASE("Servo: a released running nut stops, and a wrench meets it at rest") {
    Held held;
    const auto run = [&] {
        for (int i = 0; i < 500; ++i) {
            const Vec3 at = nut_centre(held.nut, held.state.joints[0].nut.angle);
            held.step(Grip::fingers, test::tool_at(held.nut, at, 2e-3 * i));
        }
        REQUIRE(held.state.joints[0].nut.speed > 1.0);
        return held.state.joints[0].nut.angle;
    };
    const double stands_at = run();
    const Vec3 at = nut_centre(held.nut, stands_at);
    const CommandedTool on_flats = test::tool_at(held.nut, at, stands_at + held.fits());
    held.step(Grip::wrench, on_flats);
    CHECK(held.state.joints[0].nut.speed == 0.0);
    bool held_by_wrench = false;
    for (int i = 0; i < 100; ++i) {
        const Output output = held.step(Grip::wrench, on_flats);
        held_by_wrench = held_by_wrench || output.joint == 0;
        REQUIRE(output.wrench_torque == 0.0);
        REQUIRE(held.state.joints[0].nut.angle == stands_at);
        REQUIRE(glm::length(output.torque) < 1e-3);
    }
    CHECK(held_by_wrench);
}

TEST_CASE("Servo: a device silent at full torque has zero output within 20 ms, a fault, and recovers") {
    Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    double angle = setup.wrench.head_angle;
    Output output;
    const auto input = [&] {
        const Vec3 at = nut_centre(nut, state.joints[0].nut.angle);
        return test::holding(Grip::wrench, test::tool_at(nut, at, angle));
    };
    for (int i = 0; i < 60'000 && output.wrench_torque < 150.0; ++i) {
        angle += 1e-3;
        output = tick(setup, state, input());
    }
    REQUIRE(glm::length(output.torque) > 1.0);
    CHECK(output.fault == force::Fault::none);
    TickInput silent = input();
    silent.fresh = false;
    for (int i = 0; i < 20; ++i) output = tick(setup, state, silent);
    CHECK(glm::length(output.torque) == 0.0);
    CHECK(glm::length(output.force) == 0.0);
    CHECK(output.fault == force::Fault::silent);
    for (int i = 0; i < 600; ++i) output = tick(setup, state, input());
    CHECK(output.fault == force::Fault::none);
    CHECK(glm::length(output.torque) > 1.0);

    TickInput stopped = input();
    stopped.stop = true;
    for (int i = 0; i < 20; ++i) output = tick(setup, state, stopped);
    CHECK(glm::length(output.torque) == 0.0);
    for (int i = 0; i < 2000; ++i) output = tick(setup, state, input());
    CHECK(output.fault == force::Fault::stopped);
    CHECK(glm::length(output.torque) == 0.0);
}
