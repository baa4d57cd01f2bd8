// A station without threads; tests set the samples of its devices.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "haptics/station/station_tick.hpp"
#include "tests/station/support.hpp"

namespace bolt::test {

inline station::DeviceLayout with_arm() {
    station::DeviceLayout layout;
    layout.mover = arm();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    return layout;
}

// A station whose devices send the samples set by a test, every millisecond.
struct Rig {
    explicit Rig(const station::DeviceLayout& l,
                 joint::ThreadDirection thread = joint::ThreadDirection::right)
        : layout(l),
          setup(two_joints(station::limits_of(l), Vec3(0, 1, 0), thread)),
          servo(servo::initial_state(setup)),
          state(station::initial_state(l)) {
        for (device::DeviceSnapshot* snapshot : {&inputs.mover, &inputs.wheel}) {
            snapshot->usable = true;
            snapshot->connection_number = 1;
        }
        inputs.controls.dead_man = true;
        inputs.controls.grip = servo::Grip::wrench;
    }

    station::DeviceLayout layout;
    servo::Setup setup;
    servo::State servo;
    station::StationState state;
    station::StationInputs inputs;
    std::vector<station::StationCommand> commands;  // of the next tick
    bool mover_speaks = true, wheel_speaks = true;

    station::DeviceCommands tick() {
        if (mover_speaks) ++inputs.mover.number;
        if (wheel_speaks) ++inputs.wheel.number;
        inputs.commands = commands;
        const station::DeviceCommands output = station::tick(layout, setup, state, servo, inputs);
        commands.clear();
        return output;
    }
    station::DeviceCommands ticks(int count) {
        station::DeviceCommands output;
        for (int i = 0; i < count; ++i) output = tick();
        return output;
    }
    Pose& hand() { return inputs.mover.sample.pose; }
    [[nodiscard]] const Pose& tool() const { return state.workspace.commanded_tool; }
};

// A station with the tool engaged on the first nut. Only a puck can move the tool.
inline Rig on_nut(station::DeviceLayout layout,
                  joint::ThreadDirection thread = joint::ThreadDirection::right) {
    const servo::Setup setup = two_joints(station::limits_of(layout), Vec3(0, 1, 0), thread);
    const servo::NutGeometry& nut = setup.nuts[0];
    const servo::CommandedTool at =
        tool_at(nut, servo::nut_centre(nut, 0.0), nut.sense * setup.wrench.head_angle);
    const servo::ToolPose pose = servo::tool_pose(at);
    layout.home = {pose.position, pose.orientation};
    Rig rig(layout, thread);
    rig.ticks(700);  // until the output is ramped up
    REQUIRE(rig.state.output.joint == 0);
    return rig;
}

inline bool nothing(const force::OutputCommand& c) { return c.force == Vec3(0.0) && c.torque == Vec3(0.0); }

}  // namespace bolt::test
