// What no device tells of itself: what whoever built the station knows.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::device {

struct Rig {
    // N·m that the motor gives when all is asked of it that its board lets through. Taken too high, less is
    // felt than was meant, and never more: the default is the strongest that are sold.
    double full_torque = 25.0;
    double most_torque = 2.0;  // N·m that may be rendered, whatever the motor can

    // Of the encoder, for boards that tell counts. 0: not known, the angle comes from the range below.
    double counts_per_turn = 0.0;
    // rad from stop to stop, for wheels that do not tell it.
    double range = to_radians(900.0);

    bool reversed = false;      // it pulls the other way than it ought to
    Vec3 axis{0.0, 0.0, -1.0};  // unit, device frame: to the right is with the clock, as the user sees it
};

// A puck's share of its travel into speeds. Squared: fine work needs slow hands.
struct PuckFeel {
    double speed = 0.25;      // m/s when pushed all the way
    double turn_speed = 1.5;  // rad/s when turned all the way
    double dead = 0.04;       // share that is none: pucks do not spring back to quite nothing
    double silence = 0.1;     // s without a report while pushed: it has stopped sending, and stands still
};

}  // namespace bolt::device
