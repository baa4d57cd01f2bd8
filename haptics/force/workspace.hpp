// The device's small work space and the assembly's large one: turned, scaled, and clutched: while the clutch
// is held the tool stays where it is and the hand may go back to the middle of its reach, as one lifts a
// mouse.
#pragma once

#include "engine/base/pose.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::force {

// Positions are scaled, turns are not: a quarter turn of the wrench is a quarter turn of the hand.
//
// Forces go back by the transposed map, so power is kept but for one factor on force and torque alike: at the
// device F·v + T·ω is `power` times what it is in the assembly, whatever the motion. What is passive there is
// passive here. `power` 1: a large scale makes forces larger by it. `power` 1/scale: forces as they are,
// torques less by the scale.
struct Workspace {
    Quat turn{1.0, 0.0, 0.0, 0.0};  // unit, from the device's frame to the assembly's
    double scale = 1.0;             // m of the tool for each m of the device
    double power = 1.0;
    double fade = 0.05;  // s in which forces go and come with the clutch
};

struct WorkspaceState {
    Vec3 centre{0.0};               // m: tool = centre + scale · turn · device
    Quat grip{1.0, 0.0, 0.0, 0.0};  // tool = turn · device · grip
    Pose tool;                      // of the last tick
    double share = 1.0;             // 0 … 1 of the force
};

// The tool stands at `tool` while the device stands at `device`.
WorkspaceState place(const Workspace& workspace, const Pose& device, const Pose& tool);

// One tick of dt. Where the tool is. Letting the clutch go moves nothing.
Pose to_assembly(const Workspace& workspace, WorkspaceState& state, const Pose& device, bool clutch,
                 double dt);

OutputCommand to_device(const Workspace& workspace, const WorkspaceState& state,
                        const OutputCommand& on_tool);

// What the device takes, as the assembly sees it: the output stage stands on that side of the map.
OutputLimits in_assembly(const Workspace& workspace, const OutputLimits& device);

}  // namespace bolt::force
