// Leads a hand to a nut: plans a way, pulls along it towards the farthest point that the tool sees, aligns at
// the end. Help comes and goes slowly, and whatever changes (the target, the way, the lesson's mode) changes
// only while there is none: the force never jumps.
#pragma once

#include <cstdint>

#include "haptics/force/guide_path.hpp"
#include "haptics/force/guiding.hpp"
#include "haptics/force/passivity.hpp"

namespace bolt::force {

struct GuidedTool {
    Vec3 position{0.0};
    Vec3 jaw{1.0, 0.0, 0.0};     // unit, the direction that lies along a flat
    Vec3 normal{0.0, 0.0, 1.0};  // unit
};

struct GuideGoal {
    int id = -1;  // another one is another goal; below 0: none
    GuideTarget target;
    Hexagon hexagon;
};

struct GuideState {
    GuideGoal goal;  // that the force leads to now; a new one waits until this one has faded
    GuidePath path;
    double along = 0.0;      // m of the path: the point that it pulls to
    double farthest = 0.0;   // m: where that was at most
    double strength = 0.0;   // 0 … 1, of the force
    double alignment = 0.0;  // 0 … 1, of the torque
    double patience = 0.0;   // s before a way is looked for again where there was none
    double stuck = 0.0;      // s that the tool has been at the point pulled to and not seen on

    // Of the tick before, for the energy.
    Vec3 tool{0.0}, force{0.0};
    bool at_end = false;  // of the way: it pulls to the target itself
};

// One tick of dt. `goal.id` below 0 (also: something is engaged): what help there is fades. What is wanted of
// the output stage, with its energy: leading round obstacles is granted as it comes, so the observer has no
// part in it; at the end of the way there is a potential, and the observer watches it like any spring.
Wanted guide(const Guiding& guiding, GuideState& state, const GuidedTool& tool, const GuideGoal& goal,
             Free free, double dt);

}  // namespace bolt::force
