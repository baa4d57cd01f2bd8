// A synthetic session for tests of pages and plots: twelve joints of a flange, tightened stroke by stroke in
// passes. Its curve is a closed form, so that drawings can be checked. It does not model real joints.
#pragma once

#include <cstdint>
#include <vector>

#include "game/analysis/session_data.hpp"
#include "game/session/session_file.hpp"

namespace bolt::report {

struct SyntheticOptions {
    std::uint64_t seed = 1;
    double scatter = 0.03;  // of the torque at the release of the wrench
    bool slips = false;     // mistakes: two joints swapped; one over-tightened, one unfinished, one stripped
    bool cut_short = false;
    double dt = 0.01;  // s
    double run_down_turns = 18.0;
};

// Clamp force (N), torque (N·m) and stage at an angle of `degrees` beyond the seat.
double synthetic_clamp(double degrees);
double synthetic_torque(double degrees);
joint::Stage synthetic_stage(double degrees);

content::Assembly synthetic_assembly();

struct SyntheticSession {
    analysis::SessionData data;
    std::vector<session::TickRecord> ticks;
    std::vector<lesson::LessonEvent> events;
};
SyntheticSession synthetic_session(const SyntheticOptions& options);

}  // namespace bolt::report
