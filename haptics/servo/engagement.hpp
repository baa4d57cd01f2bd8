// Which nut the hand holds, and with what. For fingers, and for a wrench that bumps into nothing, it is read
// off the poses: the jaw must be level with the nut, centred, square to the axis and aligned within its play.
// A wrench among obstacles: jaw_grip.hpp.
#pragma once

#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

struct ToolPose {
    Vec3 position{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};  // unit
    Vec3 handle{1.0, 0.0, 0.0};            // x axis of the tool
    Vec3 normal{0.0, 0.0, 1.0};            // z axis of the tool
    bool valid = true;                     // false: the sample was no pose, and holds nothing
};

ToolPose pose_of(const DeviceSample& sample);
ToolPose at_pose(const Pose& pose);

struct Engagement {
    int joint = -1;  // −1: nothing held
    Grip grip = Grip::none;
    double azimuth = 0.0;     // rad, the tool's last angle about the bolt, tightening positive, not unwrapped
    double hand_angle = 0.0;  // rad, the same unwrapped, in the nut's count
    Vec3 held_at{0.0};        // tool minus nut centre when it was engaged; relaxes to zero

    // Of a torque wrench, which is armed whenever it is put on a nut.
    double setting = 0.0;  // N·m on its scale
    double swung = 0.0;    // rad that its handle has swung

    // Of a wrench among obstacles.
    contact::JawSeat seat;
    double strength = 1.0;  // 0 … 1 of what the corners bear: it slips
    double yielded = 0.0;   // rad that it was turned beyond what they bear
};

// Centre of the nut, m: it comes down as it turns.
Vec3 nut_centre(const NutPlace& nut, double nut_angle);

// Angle of the jaw (or of the fingers) about the bolt, rad, tightening positive.
double tool_azimuth(const Setup& setup, const NutPlace& nut, const ToolPose& tool, Grip grip);

// Lets go when the grip changes, the tool is pulled away or tilted off, its angle leaps further than a hand
// can turn in a tick, or the sample is no pose; takes hold when it fits.
void update_engagement(const Setup& setup, std::span<const joint::JointState> joints, const ToolPose& tool,
                       Grip grip, Engagement& engagement);

}  // namespace bolt::servo
