// The servo tick: a pure step of fixed dt. No clock, lock, allocation or I/O; the same inputs give the same
// bits.
//
//   1 hand pose → wrench pose, as far as obstacles allow   touch.hpp
//   2 which nut is held, and how well                      engagement.hpp, jaw_grip.hpp
//   3 nut and joint: angle, stage, torque                  joint/group.hpp
//   4 what the nut does to the hand, or the guiding force on its way there   force/guide.hpp
//   5 output stage: watchdog, passivity, limits                              force/output_stage.hpp
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "haptics/force/guide.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::servo {

// Fingers that open, a hand that gives up its hold: what drew the tool to the nut goes within 50 ms, not at
// once.
struct Opening {
    Vec3 drawn_to{0.0};
    double share = 0.0;  // of the stiffness that is left
};

// How nuts and joints stood once.
struct Mark {
    std::vector<joint::JointState> joints;
    std::vector<double> rounded;
};

struct State {
    std::uint64_t tick = 0;
    std::vector<joint::JointState> joints;
    std::vector<double> rounded;  // m of each nut's flats that slipping jaws took off
    Engagement engagement;
    Vec3 drawn_to{0.0};  // where an engaged tool is held, m
    Opening opening;
    force::OutputCommand helped;  // by the guiding force in the tick before
    force::GuideState guide;
    force::OutputStage output;
    std::optional<Touch> touch;          // none: nothing is bumped into
    std::array<Mark, most_marks> marks;  // a ring
    std::uint32_t marked = 0;            // since the beginning
};

State initial_state(const Setup& setup);

// `free`: whether the straight way between two points is, for the guiding force; without it every way is.
Output tick(const Setup& setup, State& state, const Input& input);
Output tick(const Setup& setup, State& state, const Input& input, force::Free free);

}  // namespace bolt::servo
