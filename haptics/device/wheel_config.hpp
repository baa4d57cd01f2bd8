// Properties that a wheel does not report: the builder of the station enters them.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::device {

struct WheelConfig {
    // Motor torque at full drive, N·m. Overestimating it weakens the rendered torque, which is the safe side;
    // the default is that of the strongest wheels on the market.
    double full_torque = 25.0;
    double max_torque = 2.0;  // N·m, limit of the rendered torque

    // Encoder counts per turn, for boards that report counts. 0: unknown, the angle follows from `range`.
    double counts_per_turn = 0.0;
    // rad from stop to stop, for wheels that do not report it.
    double range = to_radians(900.0);

    bool reversed = false;      // the motor pulls in the opposite direction
    Vec3 axis{0.0, 0.0, -1.0};  // unit, device frame: clockwise as the user sees it is positive
};

// Maps the deflection of a puck to velocity. Quadratic, for fine control at low speed.
struct PuckResponse {
    double speed = 0.25;      // m/s at full deflection
    double turn_speed = 1.5;  // rad/s at full deflection
    double dead_zone = 0.04;  // deflection that counts as zero: pucks do not centre exactly
    double silence = 0.1;     // s without a report while deflected until the velocity becomes zero
};

}  // namespace bolt::device
