// Path planning for a simulated hand: free room for a handle and collision-free reaches. Queries the
// obstacles of the contact simulation.
#pragma once

#include <vector>

#include "game/motion/minimum_jerk.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::motion {

// Orientation of a tool whose handle stands at the given angle about the bolt (tightening positive).
Quat orientation_of(const servo::NutGeometry& nut, double handle_angle, bool flipped);

struct Way {
    Vec3 bulge{0.0};             // m, off the straight way (minimum_jerk.hpp)
    std::vector<Pose> stations;  // poses to go to first, straight: where it cannot be reached in one go
};

// A reach from one pose to the other in which the wrench meets nothing that can be seen: off the straight way
// along `up` by `least` or more, else to a side too, else straight up, across and down, else by way of a
// place in the open where the wrench is turned; over the top as high as was tried if there is none.
Way way_round(const servo::Setup& setup, const servo::ToolContact& touch, const Pose& from, const Pose& to,
              const Vec3& up, double least);

struct GripAngle {
    double handle = 0.0;  // rad, about the bolt
    bool flipped = false;
    double room = 0.0;  // rad that the handle may swing from there
};

// Of the angles at which the jaw fits (every 60°, and 30° between with the wrench flipped), the one nearest
// to `wanted` that has room for a pull of `stroke` in the sense of `sign` (tightening positive), and to get
// there. Without obstacles all have.
GripAngle choose_grip(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                      double nut_angle, double wanted, double sign, double stroke);

// m above its nut where a wrench that is to go onto it waits: at most `most`, less where something stands
// over the nut.
double room_above(const servo::Setup& setup, const servo::ToolContact& touch, std::size_t joint,
                  double nut_angle, const GripAngle& grip, double most);

// A hand is not stronger than this: where the wrench stays behind, it does too.
Pose give_way(const Pose& wanted, const Pose& wrench);

}  // namespace bolt::motion
