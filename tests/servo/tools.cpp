// A lesson with several tools: the change of the tool between two ticks.
#include <doctest/doctest.h>

#include "tests/servo/support.hpp"
#include "tests/support/forbidden.hpp"

namespace bolt::servo::several_tools {

namespace {

// Two nuts: the first is turned by an open end, the second by a ring with a handle of 0.3 m.
Setup two_tools(const force::OutputLimits& limits = {}, double max_torque = 210.0) {
    std::vector<joint::JointDesign> designs(2, test::m16_flange_joint());
    designs[1].seat = Vec3(0.2, 0.0, 0.0);
    SetupDescription description;
    description.joints = designs;
    description.tool.head = collision::make_jaw(24.2e-3, to_radians(15.0));
    description.tool.head_angle = to_radians(15.0);
    description.tool.handle_length = 0.23;
    ToolDescription ring;
    ring.head = collision::Ring{24.2e-3, 12, -12e-3, 12e-3, 1e-3, 37e-3, false, 0.0};
    ring.handle_length = 0.3;
    description.more_tools = {ring};
    description.tool_of_joint = {0, 1};
    description.max_torque = max_torque;
    description.limits = limits;
    return make_setup(description);
}

TickInput at_nut(const Setup& setup, std::size_t joint, Grip grip, std::uint8_t tool) {
    const NutGeometry& nut = setup.nuts[joint];
    TickInput input = test::holding(grip, test::tool_at(nut, nut_centre(nut, 0.0), setup.wrench.head_angle));
    input.tool = tool;
    return input;
}

}  // namespace

TEST_CASE("Several tools: each has its own head, handle and grip height") {
    Setup setup = two_tools();
    REQUIRE(setup.tools.size() == 2);
    CHECK(setup.nuts[0].tool == 0);
    CHECK(setup.nuts[1].tool == 1);
    CHECK(setup.wrench.handle_length == 0.23);
    const double middle = setup.nuts[0].grip_height;
    CHECK(middle == 0.5 * setup.nuts[0].height);
    use_tool(setup, 1);
    CHECK(setup.wrench.handle_length == 0.3);
    CHECK(setup.wrench.head_angle == 0.0);
    CHECK(setup.nuts[0].grip_height > middle);  // a ring of 24 mm stands above the seat
    use_tool(setup, 0);
    CHECK(setup.nuts[0].grip_height == middle);
}

TEST_CASE("Several tools: the hand takes the next tool only when it holds none, without allocating") {
    Setup setup = two_tools();
    State state = initial_state(setup);
    // In the hand: no change, on a nut or beside it.
    for (int i = 0; i < 5; ++i) {
        const TickInput input = at_nut(setup, 0, Grip::wrench, 1);
        change_tool(setup, state, input);
        tick(setup, state, input);
        CHECK(setup.tool == 0);
    }
    CHECK(state.engagement.joint == 0);
    // The tick in which the hand opens still ends the hold; the next one changes the tool.
    for (int i = 0; i < 2; ++i) {
        const TickInput input = at_nut(setup, 1, Grip::none, 1);
        CHECK(test::forbidden_in([&] { change_tool(setup, state, input); }).all() == 0);
        tick(setup, state, input);
    }
    CHECK(setup.tool == 1);
    const TickInput input = at_nut(setup, 1, Grip::wrench, 1);
    change_tool(setup, state, input);
    tick(setup, state, input);
    CHECK(state.engagement.joint == 1);
    // A tool that the lesson lacks is ignored.
    TickInput wrong = at_nut(setup, 1, Grip::none, 7);
    wrong.commanded_tool.position[1] += 1.0F;
    for (int i = 0; i < 3; ++i) {
        change_tool(setup, state, wrong);
        tick(setup, state, wrong);
    }
    CHECK(setup.tool == 1);
}

TEST_CASE("Several tools: without torque output the force at the handle's end is that of the tool in use") {
    force::OutputLimits limits;
    limits.torque = 0.0;
    Setup setup = two_tools(limits, 3.0);  // a device that renders it without scaling it
    for (const std::size_t tool : {1U, 0U}) {
        use_tool(setup, tool);
        const double length = setup.wrench.handle_length;
        const force::TorqueRendering expected = force::make_torque_rendering(limits, 3.0, length);
        CHECK(setup.torque_rendering.as_force == expected.as_force);
        CHECK(setup.torque_rendering.as_force == doctest::Approx(1.0 / length));
        CHECK(setup.guiding.max_torque == doctest::Approx(0.2 * limits.force * length));
    }
    CHECK(setup.tools[0].torque_rendering.as_force > setup.tools[1].torque_rendering.as_force);
    // Sessions before format 11.
    setup.renders_tool_in_use = false;
    use_tool(setup, 1);
    CHECK(setup.torque_rendering.as_force == setup.tools[0].torque_rendering.as_force);
}

TEST_CASE("Several tools: the end of another handle is elsewhere, but the hand has not jumped there") {
    force::OutputLimits limits;
    limits.torque = 0.0;
    for (const bool follows : {true, false}) {
        Setup setup = two_tools(limits);
        setup.renders_tool_in_use = follows;
        State state = initial_state(setup);
        TickInput input = at_nut(setup, 0, Grip::none, 0);
        input.commanded_tool.position[1] += 0.5F;
        input.dead_man = true;
        force::Fault fault = force::Fault::none;
        for (int i = 0; i < 20; ++i) {
            input.tool = i < 10 ? 0 : 1;
            change_tool(setup, state, input);
            fault = std::max(fault, tick(setup, state, input).fault);
        }
        CHECK(setup.tool == 1);
        CHECK(state.lever_arm == 0.3);
        CHECK(fault == (follows ? force::Fault::none : force::Fault::jumped));
        if (follows) CHECK(glm::length(state.output_stage.watchdog.motion.velocity) < 1e-9);
    }
}

}  // namespace bolt::servo::several_tools
