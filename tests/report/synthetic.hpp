// A session made up for the tests of pages and plots: twelve joints of a flange, tightened stroke by stroke
// in passes. Its curve is a closed form, so that what is drawn can be checked; it claims nothing about real
// joints.
#pragma once

#include <cstdint>
#include <vector>

#include "game/analysis/session_data.hpp"
#include "game/session/session_file.hpp"

namespace bolt::report {

struct SyntheticOptions {
    std::uint64_t seed = 1;
    double scatter = 0.03;  // of the torque at which the wrench is let go
    bool slips = false;     // a swap in the order, an over-tightened and an unfinished joint, a broken one
    bool cut_short = false;
    double dt = 0.01;  // s
    double run_down_turns = 18.0;
};

// Clamp force (N) and torque (N·m) at the degrees beyond the seat.
double synthetic_clamp(double degrees);
double synthetic_torque(double degrees);
joint::Stage synthetic_stage(double degrees);

content::Assembly synthetic_assembly();

struct SyntheticSession {
    SessionData data;
    std::vector<session::TickRecord> ticks;
    std::vector<lesson::Event> events;
};
SyntheticSession synthetic_session(const SyntheticOptions& options);

}  // namespace bolt::report
