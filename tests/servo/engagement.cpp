#include "haptics/servo/engagement.hpp"

#include <doctest/doctest.h>

#include "tests/servo/support.hpp"

using namespace bolt;
using namespace bolt::servo;

TEST_CASE("Engagement: half play of a 24.2 mm jaw on a 24 mm hexagon is 0.84 degrees") {
    CHECK(to_degrees(test::two_joints().wrench.half_play) == doctest::Approx(0.8376).epsilon(1e-4));
}

TEST_CASE("Engagement: clockwise seen from the nut tightens a right-hand thread, for any axis") {
    Random random(2);
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 axis =
            glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(0, 1e-3, 0));
        const Setup setup = test::two_joints({}, axis);
        const NutGeometry& nut = setup.nuts[0];
        CHECK(glm::length(glm::cross(nut.e1, nut.e2) - nut.axis) < 1e-12);
        // Turn the tool by −10° about the axis (clockwise from outside): tightening is +10°.
        const CommandedTool before = test::tool_at(nut, Vec3(0.0), 0.3);
        ToolPose tool = tool_pose(before);
        const double a = tool_azimuth(setup, nut, tool, Grip::fingers);
        const Quat turn = glm::angleAxis(to_radians(-10.0), nut.axis);
        tool.handle = turn * tool.handle;
        CHECK(to_degrees(tool_azimuth(setup, nut, tool, Grip::fingers) - a) ==
              doctest::Approx(10.0).epsilon(1e-4));
    }
}

TEST_CASE("Engagement: the jaw fits every 60 degrees, and flipped 30 degrees between") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    const Vec3 centre = nut_centre(nut, 0.0);
    int upright = 0, flipped = 0;
    double last_upright = 0.0, last_flipped = 0.0;
    for (int tenth = 0; tenth < 3600; ++tenth) {
        for (const bool flip : {false, true}) {
            Engagement e;
            const CommandedTool sample = test::tool_at(nut, centre, to_radians(0.1 * tenth), flip);
            update_pose_engagement(setup, state.joints, tool_pose(sample), Grip::wrench, e);
            if (e.joint != 0) continue;
            double& last = flip ? last_flipped : last_upright;
            if (0.1 * tenth - last > 10.0 || (flip ? flipped : upright) == 0) {
                ++(flip ? flipped : upright);
                last = 0.1 * tenth;
            }
        }
    }
    CHECK(upright == 6);
    CHECK(flipped == 6);
    const double apart = std::abs(wrap(to_radians(last_upright - last_flipped), pi / 3));
    CHECK(to_degrees(apart) == doctest::Approx(30.0).epsilon(0.01));
}

TEST_CASE("Engagement: a jaw that is off centre, tilted, too high or misaligned does not fit; fingers do") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const NutGeometry& nut = setup.nuts[0];
    const Vec3 centre = nut_centre(nut, 0.0);
    const double fits = setup.wrench.head_angle;  // handle angle at which the jaw is aligned with the flats
    const auto holds = [&](Grip grip, const Vec3& at, double angle, double tilt) {
        ToolPose tool = tool_pose(test::tool_at(nut, at, angle));
        tool.normal = glm::angleAxis(tilt, nut.e1) * tool.normal;
        Engagement e;
        update_pose_engagement(setup, state.joints, tool, grip, e);
        return e.joint == 0;
    };
    CHECK(holds(Grip::wrench, centre, fits, 0.0));
    CHECK_FALSE(holds(Grip::wrench, centre + 0.003 * nut.e1, fits, 0.0));
    CHECK_FALSE(holds(Grip::wrench, centre + 0.008 * nut.axis, fits, 0.0));
    CHECK_FALSE(holds(Grip::wrench, centre, fits + to_radians(2.0), 0.0));
    CHECK_FALSE(holds(Grip::wrench, centre, fits, to_radians(6.0)));
    CHECK_FALSE(holds(Grip::none, centre, fits, 0.0));
    CHECK(holds(Grip::fingers, centre + 0.008 * nut.e1, fits + to_radians(2.0), to_radians(6.0)));
}

TEST_CASE("Engagement: NaN, infinity and invalid quaternions engage nothing and make no force") {
    const Setup setup = test::two_joints();
    State state = initial_state(setup);
    const float nan = std::nanf("");
    for (int i = 0; i < 100; ++i) {
        TickInput input;
        input.dead_man = true;
        input.grip = Grip::wrench;
        input.guided_joint = static_cast<std::int16_t>(i % 5 - 2);
        for (float& x : input.commanded_tool.position) x = i % 2 == 0 ? nan : INFINITY;
        for (float& x : input.commanded_tool.orientation) x = i % 3 == 0 ? nan : i % 3 == 1 ? 0.0F : 1e30F;
        const Output output = tick(setup, state, input);
        REQUIRE(output.joint == -1);
        REQUIRE(glm::length(output.force) == 0.0);
    }
}
