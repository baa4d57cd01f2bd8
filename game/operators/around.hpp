// How a simulated hand gets round what is in the way: it sees where a handle has room and how high a reach
// must go, and where the wrench stops it gives way. What it sees is asked of the same obstacles that hold the
// wrench.
#pragma once

#include "game/operators/motion.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::operators {

// m: the least rise along `up` of a reach from one pose to the other, from `least` on, in which the wrench
// meets nothing that can be seen from it; the highest tried if there is none.
double rise_over(const servo::Setup& setup, const servo::Touch& touch, const Pose& from, const Pose& to,
                 const Vec3& up, double least);

// rad: how far a handle that stands at `angle` about a nut may swing in the sense of `sign` (tightening
// positive) before it meets something; at most `most`. Below zero: it has no room where it stands.
double swing_room(const servo::Setup& setup, const servo::Touch& touch, std::size_t joint, double nut_angle,
                  double angle, double sign, double most);

// A hand is not stronger than this: where the wrench stays behind, it does too.
Pose give_way(const Pose& wanted, const Pose& wrench);

}  // namespace bolt::operators
