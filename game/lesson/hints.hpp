// Selects hints over time: they become more explicit the longer the work makes no progress, and do not
// flicker.
//
//   guided:     text at once, then outline and arrow, then a ghost, then the animated motion
//   practice:   the same after a long time, or one level more for each request
//   assessment: none, also on request
//
// A hint stays for 1.5 s, unless the step changes, the trainee has to stop, or its request has been
// fulfilled.
#pragma once

#include <optional>

#include "game/lesson/hint.hpp"

namespace bolt::lesson {

// Time without progress after which each level is reached, s.
struct HintTimes {
    std::array<double, 4> level;
};
inline constexpr HintTimes guided_times{{0.0, 4.0, 9.0, 15.0}};
inline constexpr HintTimes practice_times{{20.0, 35.0, 50.0, 65.0}};

inline constexpr double shortest_hint = 1.5;       // s
inline constexpr double shortest_when_past = 0.5;  // s, when what it asked for has been done

// The best values reached in a step; a new best is progress.
struct Progress {
    double torque = 0.0;    // N·m, most of it in this step
    double angle = 0.0;     // rad, furthest in the step's sense
    double distance = 1e9;  // m to the nut, least since the hand let go of what it had moved
    int reached = 0;        // likewise: 1 the right tool in the hand, 2 on the nut
    bool moved = false;     // the nut, since the hand took it
    double idle = 0.0;      // s since the last of it
};

struct Hints {
    std::optional<Hint> shown;                  // none: nothing is said
    Situation situation = Situation::all_done;  // for which it is said
    double stands = 0.0;                        // s that it has been so
    Situation seen = Situation::all_done;       // in the last frame, and
    double seen_for = 0.0;                      // s for which
    double other_for = 0.0;                     // s that something else was seen than is said
    Situation then = Situation::all_done;       // behind an announcement
    std::size_t step = SIZE_MAX;
    double step_for = 0.0;  // s
    int pass = -1;
    bool new_round = false;
    int level = -1;  // in this situation; −1: none yet
    int held = -1;
    Progress progress;
};

// Advances by a frame of `dt` seconds. `asked`: the trainee requested help in this frame.
const std::optional<Hint>& update(Hints& hints, const Scene& scene, double dt, bool asked = false);

}  // namespace bolt::lesson
