// The guiding force: plans a path to a nut, pulls the tool towards the farthest point of the path in its line
// of sight and aligns the jaw at the end. The force fades in and out, and goal or path change only while it
// is zero, so it is continuous.
#pragma once

#include <cstdint>

#include "haptics/force/guide_path.hpp"
#include "haptics/force/guiding.hpp"
#include "haptics/force/passivity.hpp"

namespace bolt::force {

struct GuidedTool {
    Vec3 position{0.0};
    Vec3 jaw{1.0, 0.0, 0.0};     // unit, direction that aligns with a flat of the hexagon
    Vec3 normal{0.0, 0.0, 1.0};  // unit
};

struct GuideGoal {
    int id = -1;  // identifies the goal; negative: none
    GuideTarget target;
    Hexagon hexagon;
};

struct GuideState {
    GuideGoal goal;  // goal of the present force; replaced once that has faded out
    GuidePath path;
    double along = 0.0;      // m along the path: the pull point
    double farthest = 0.0;   // m, largest value of `along` on this path
    double strength = 0.0;   // 0 … 1, of the force
    double alignment = 0.0;  // 0 … 1, of the torque
    double patience = 0.0;   // s until the next attempt to plan a path
    double stuck = 0.0;      // s that the tool has been at the pull point without sight of the path beyond

    // Values of the last tick, for the energy balance.
    Vec3 tool{0.0}, force{0.0};
    bool at_end = false;  // the pull point is the target
};

// One tick of dt. With a negative `goal.id` the force fades out; pass that while a nut is engaged. Returns
// the request to the output stage: along the path all work counts as injected energy, so the passivity
// observer ignores it; at the target the force is a potential, which the observer watches like any spring.
ForceRequest guide(const GuidingParameters& guiding, GuideState& state, const GuidedTool& tool,
                   const GuideGoal& goal, IsSegmentFree free, double dt);

}  // namespace bolt::force
