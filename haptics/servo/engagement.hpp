// Determines which nut the hand holds. This file covers fingers, and a wrench without contact simulation:
// they engage if the pose fits, that is level with the nut, centred, square to the axis and aligned within
// the play. With contact simulation jaw_grip.hpp applies.
#pragma once

#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

struct ToolPose {
    Vec3 position{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // unit
    Vec3 handle{1.0, 0.0, 0.0};            // x axis of the tool
    Vec3 normal{0.0, 0.0, 1.0};            // z axis of the tool
    bool valid = true;                     // false: the sample is not a pose; such a tool engages nothing
};

// `valid` is false if the sample is not finite, is beyond 1 km or has no unit quaternion.
ToolPose pose_of(const DeviceSample& sample);
ToolPose at_pose(const Pose& pose);

struct Engagement {
    int joint = -1;  // −1: no nut is held
    Grip grip = Grip::none;
    double azimuth = 0.0;  // rad, last angle of the tool about the bolt, tightening positive, not unwrapped
    double hand_angle = 0.0;  // rad, the same unwrapped and counted as the nut's angle
    Vec3 held_at{0.0};        // m, tool minus nut centre at engagement; decays with a time constant of 0.05 s

    // Click-type torque wrench; armed anew at each engagement.
    double setting = 0.0;  // N·m on the scale
    double swung = 0.0;    // rad that the handle has swung since the click

    // Wrench with contact simulation.
    collision::JawSeat seat;
    double strength = 1.0;  // 0 … 1 of the corner torque that is left while the jaw slips
    double yielded = 0.0;   // rad turned beyond the corner torque
};

// Centre of the nut in the assembly's frame, m, at `nut_angle` rad.
Vec3 nut_centre(const NutGeometry& nut, double nut_angle);

// Angle of the jaw or of the fingers about the bolt, rad, tightening positive, not unwrapped.
double tool_azimuth(const Setup& setup, const NutGeometry& nut, const ToolPose& tool, Grip grip);

// One tick. Releases the nut if the grip changes, the tool moves or tilts away, its angle changes by more
// than a hand can turn in a tick, or the sample is not a pose. Engages a nut if none was held and the pose
// fits.
void update_engagement(const Setup& setup, std::span<const joint::JointState> joints, const ToolPose& tool,
                       Grip grip, Engagement& engagement);

}  // namespace bolt::servo
