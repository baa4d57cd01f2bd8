// Maps the device's small workspace to the assembly's (rotation, scale and clutch), and a bolt's torque to
// the device's range. While the clutch is held the tool stands still and the hand can return to the middle of
// its reach, as when a mouse is lifted.
#pragma once

#include <limits>

#include "engine/base/math.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::force {

// Positions are scaled, rotations are not: a quarter turn of the wrench is a quarter turn of the hand.
//
// With R = rotation, s = scale, p = power_ratio, motions at the device (v, ω) and forces on the tool (F, T):
//
//   on the tool      v' = s R v       ω' = R ω
//   on the device    F' = p s R⁻¹ F   T' = p R⁻¹ T
//
// Forces use the transposed map, so F'·v + T'·ω = p (F·v' + T·ω'): the power at the device is p times the
// power in the assembly, and passivity carries over. With p = 1 forces grow with the scale, F' = s R⁻¹ F and
// T' = R⁻¹ T. With p = 1/s forces are unchanged and torques shrink by the scale, F' = R⁻¹ F and T' = R⁻¹ T/s.
struct WorkspaceMap {
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // unit, from the device's frame to the assembly's
    double scale = 1.0;                 // m of the tool per m of the device
    double power_ratio = 1.0;           // power at the device / power at the tool
    double fade = 0.05;                 // s in which forces fade out and in with the clutch
    // Infinite: the mapping is relative, as for an arm. The offsets in WorkspaceState (`centre` and
    // `tool_to_device`) keep the values that realign() gave them. Finite: the mapping is absolute, for a
    // tracked hand that the picture shows. Then both offsets decay with this time constant, s;
    // `tool_to_device` only while the lever arm is 0, because a wrench keeps its orientation in the hand.
    double return_time = std::numeric_limits<double>::infinity();
};

struct WorkspaceState {
    Vec3 centre{0.0};  // m: lever end = centre + scale · heading · rotation · device position
    // Tool orientation = heading · rotation · device orientation · tool_to_device.
    Quat tool_to_device{1.0, 0.0, 0.0, 0.0};
    // Unit, a rotation about the assembly's y. It follows the view, so that the hand's right stays right in
    // the picture.
    Quat heading{1.0, 0.0, 0.0, 0.0};
    // m from the tool's origin along its x to the point that follows the device: 0 for fingers and for a
    // device with torque; the length of the wrench for a device whose force acts at the end of the handle.
    double lever_arm = 0.0;
    Pose commanded_tool;       // in the assembly's frame, at the last tick
    double force_share = 1.0;  // 0 … 1, share of the force that is rendered
};

// Returns the state in which the device pose `device` maps to the tool pose `tool`.
WorkspaceState align_workspace(const WorkspaceMap& workspace, const Pose& device, const Pose& tool);

// Changes `state` so that the device pose `device` maps to the tool pose `tool`; keeps heading, lever arm and
// share.
void realign(const WorkspaceMap& workspace, WorkspaceState& state, const Pose& device, const Pose& tool);

// The end of the lever arm, in the assembly's frame: the point of the tool that follows the device.
Vec3 lever_end(const WorkspaceState& state, const Pose& tool);

// The pose of the device's frame in the assembly's. At a scale of 1 it maps the device's position to the end
// of the lever arm; at other scales it does not.
Pose device_in_assembly(const WorkspaceMap& workspace, const WorkspaceState& state);

// One tick of dt. Returns the tool's pose in the assembly's frame. Releasing the clutch does not move the
// tool. A device pose that is not finite is returned unchanged for the watchdog to reject.
Pose to_assembly(const WorkspaceMap& workspace, WorkspaceState& state, const Pose& device, bool clutch,
                 double dt);

// A bolt that holds a wrench, in the assembly's frame.
struct Pivot {
    Vec3 centre{0.0};          // m, a point on its axis
    Vec3 axis{0.0, 1.0, 0.0};  // unit
};

// The pose of a wrench that sits on a bolt, while the hand holds its handle at `lever_end`, `lever_arm` m
// from the jaw: the pose `held`, turned about the bolt so that the handle points to `lever_end`, and then
// translated until the handle ends there, even if that takes the jaw off the axis of the bolt. The device's
// orientation has no effect, because a device without torque cannot hold the wrist. If `lever_end` is on the
// axis, `held` is moved but not turned.
Pose pivoted(const Pivot& pivot, const Pose& held, double lever_arm, const Vec3& lever_end);

// The smallest scale, at least 1, at which the end of a wrench of `handle_length` m that points to the user
// swings by 60° within 90 % of the device's reach (m, half the workspace along each axis). Only x and z
// count; a reach of 0 is unknown and does not raise the scale.
double fitted_scale(const Vec3& reach, double handle_length);

// The reach (m, half the workspace, from its middle) along the axes of the frame into which `rotation` maps
// the device's frame. 0 if the reach along a device axis that contributes is unknown.
Vec3 rotated_half_workspace(const Quat& rotation, const Vec3& reach);

// The command, in the device's frame, that renders the force and torque `on_tool` (assembly's frame), times
// WorkspaceState::force_share.
OutputCommand to_device(const WorkspaceMap& workspace, const WorkspaceState& state,
                        const OutputCommand& on_tool);

// The device's limits in the assembly's units; the output stage works in these.
OutputLimits in_assembly(const WorkspaceMap& workspace, const OutputLimits& device);

// Renders a bolt's torque on a device with a smaller range. The torque is scaled so that the largest torque
// of the lesson stays within this range. It is rendered as a torque if the device has torque output,
// otherwise as a force at the end of the wrench's handle.

struct TorqueRendering {
    double scale = 1.0;     // device torque / true torque; 0: none
    double as_force = 0.0;  // N at the end of the handle per N·m; the physical value is 1/handle length
};

// The scales never exceed the physical values. `max_torque`: the largest torque of the lesson, N·m; less than
// 1 counts as 1; `handle_length` in m.
TorqueRendering make_torque_rendering(const OutputLimits& limits, double max_torque, double handle_length);

// `torque` in N·m; positive torque, which resists tightening, turns the hand about `loosening_axis` (unit),
// right-handed. `handle` is the unit vector from the bolt to the end of the handle.
OutputCommand render_torque(const TorqueRendering& rendering, double torque, const Vec3& loosening_axis,
                            const Vec3& handle);

// J. The part of the stored energy torque²/(2 stiffness) that the rendered force can return to the hand.
// `stiffness` in N·m/rad.
double stored_torque_energy(const TorqueRendering& rendering, double torque, double stiffness,
                            double handle_length);

}  // namespace bolt::force
