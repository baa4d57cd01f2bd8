// A torque–angle curve of one joint alone, turned at constant speed as a test bench turns it.
#pragma once

#include <vector>

#include "haptics/joint/group.hpp"

namespace bolt::joint {

struct CurveSample {
    double angle = 0.0;  // rad from the start of the run
    Stage stage = Stage::navigation;
    double torque = 0.0;  // N·m; loosening negative. Law `published`: with the signs of the print
    double clamp = 0.0;   // N
};

struct CurveOptions {
    Direction direction = Direction::tighten;
    double speed = to_radians(30.0);  // rad/s
    double dt = 0.001;                // s, one sample a step
    // Tightening ends `past_yield` after the yield stage has begun, or where the joint breaks or strips.
    // Loosening starts from a joint tightened to `torque`, rested for 10 s, and ends when the nut has been
    // free for a quarter turn.
    double past_yield = to_radians(90.0);
    double torque = 0.0;
};

// `group` with one joint. Never longer than 2,000,000 samples.
std::vector<CurveSample> torque_angle_curve(const GroupParameters& group, const CurveOptions& options);

}  // namespace bolt::joint
