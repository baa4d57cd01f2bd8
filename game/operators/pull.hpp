// A simulated hand at work on a nut: it puts in a torque that grows as fast as it dares, and stops where it
// feels that it has come there.
#pragma once

#include "game/operators/mind.hpp"

namespace bolt::operators {

// One tick each. With a wrench, for as far as there is room to swing it; fingers, for one twist.
void pull(Mind& mind, const Feeling& felt);
void spin(Mind& mind, const Feeling& felt);

// The wrench springs back before it comes off; fingers open, the hand turns back to take hold again.
void ease(Mind& mind);
void spin_back(Mind& mind);

}  // namespace bolt::operators
