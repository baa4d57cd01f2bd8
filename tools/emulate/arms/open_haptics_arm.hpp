// The mechanics of the emulated arm of OpenHaptics: a stylus on three motors and, on some models, a gimbal
// with three more, held by a hand. SI units; the frame of the library (x to the right, y up, z to the user).
#pragma once

#include <array>
#include <string>

#include "tools/emulate/arms/open_haptics.h"

namespace bolt::emulate {

using HdVector = std::array<double, 3>;
using HdMatrix = std::array<HdVector, 3>;  // rows

constexpr double hd_time_step = 25e-6;  // s, of step()

struct HdArm {
    EmulatedHdHand hand{0.5, 300.0, 12.0, 0.2};
    // The description that the arm reports, in the vendor's units.
    EmulatedHdReport report{"Touch", 6, 3, {-80, -50, -50, 80, 70, 70}, 0.5, 3.3, 0.88};
    std::string model{"Touch"};
    HdVector intention{}, position{};  // m; the hand's spring pulls the stylus to `intention`
    HdVector velocity{};               // m/s
    HdVector force{};                  // N, of the motors on the hand
    HdVector gimbal_torque{};          // N·m, of each motor of the gimbal
    HdVector gimbal{};                 // rad, the angle of each joint of the gimbal
    HdMatrix forearm{HdVector{1, 0, 0}, HdVector{0, 1, 0}, HdVector{0, 0, 1}};  // its orientation
    double time = 0.0;                                                          // s
};

double length(const HdVector& v);

// Moves hand and stylus by `hd_time_step`. `powered`: the motors render `force`.
void step(HdArm& arm, bool powered);

// The orientation of the stylus; the columns are its axes.
HdMatrix orientation(const HdArm& arm);

// N·m, on the stylus: its component along the axis of each motor is the torque of that motor.
HdVector torque_on_hand(const HdArm& arm);

// m, as the encoders report it; 20 mm off along each axis before calibration.
HdVector measured_position(const HdArm& arm, bool calibrated);

// Limits a force and the torques of the gimbal to those of the motors. Returns true if any was greater.
bool saturate(const HdArm& arm, HdVector& force, HdVector& gimbal_torque);

}  // namespace bolt::emulate
