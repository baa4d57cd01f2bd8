// The servo tick: a pure step of fixed dt. No clock, lock, allocation or I/O; the same inputs give the same
// bits.
//
//   1 hand pose → which nut is held        engagement.hpp
//   2 nut and joint: angle, stage, torque   joint/group.hpp
//   3 coupling forces, or the guiding force
//   4 output stage: slew, clamp, dead-man   force/output_stage.hpp
#pragma once

#include <cstdint>
#include <vector>

#include "haptics/servo/engagement.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

struct State {
    std::uint64_t tick = 0;
    std::vector<joint::JointState> joints;
    Engagement engagement;
    force::OutputStage output;
};

State initial_state(const Setup& setup);

Output tick(const Setup& setup, State& state, const Input& input);

}  // namespace bolt::servo
