// How hard the hand that is shown works, where no device lets it be felt. Only of what a tick put out: the
// same session shows the same hand.
#pragma once

#include "game/world/haptics.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::scene {

struct Strain {
    double share = 0.0;   // 0 at rest … 1: the most that this hand can
    double tremor = 0.0;  // −1 … 1, of the muscles: what changes in the torque faster than a hand follows
    double quick = 0.0;   // the same share, less smooth, with the torque's sign
    double slow = 0.0;
};

// What the wrench bears at most is what its spring gives at 2.5 degrees (hud.cpp), fingers slip before
// that. −1 … 1, tightening positive; 0 with nothing in the hand.
using EffortAccess = ecs::Access<const world::Joint, const world::ToolContact, const world::Hand>;
double effort(const servo::Setup& setup, const EffortAccess& world);

// A tick.
void strain(Strain& strain, const servo::Setup& setup, const EffortAccess& world);

}  // namespace bolt::scene
