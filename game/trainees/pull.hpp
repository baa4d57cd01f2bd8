// A simulated hand that turns a nut: its torque grows at the trainee's rate and stops when the felt torque
// reaches the goal.
#pragma once

#include "game/trainees/trainee_state.hpp"

namespace bolt::trainees {

// One tick each. With a wrench, for as far as there is room to swing it; fingers, for one twist.
void pull(Mind& mind, const Feeling& felt);
void spin(Mind& mind, const Feeling& felt);

// The wrench springs back before it comes off; fingers open, the hand turns back to take hold again.
void ease(Mind& mind);
void spin_back(Mind& mind);

}  // namespace bolt::trainees
