// One hint: its text, how explicit it is, and what the view shows of it.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/situation.hpp"

namespace bolt::lesson {

// The motion of the hand that a hint requests. It selects the arrow and the control that is named.
enum class Motion : std::uint8_t {
    none,
    take,
    put_away,
    approach,  // with the wrench
    reach,     // with the fingers
    set_on,
    grip_nut,
    spin,
    twist_back,
    let_go,
    pull_on,
    pull_off,
    lift,
    set_back,
};
inline constexpr std::size_t motion_count = 14;

enum class Ghost : std::uint8_t { none, hand, hand_and_wrench };

struct Hint {
    Situation situation = Situation::all_done;
    int level = 0;   // 0: text; 1: outline and arrow; 2: ghost; 3: the very motion, and what to press for it
    int joint = -1;  // the due one; −1: none is
    Motion motion = Motion::none;
    words::Key text = "hint.all_done";
    std::vector<words::Place> places;

    [[nodiscard]] int outlined() const { return level >= 1 ? joint : -1; }
    [[nodiscard]] Motion arrow() const { return level >= 1 ? motion : Motion::none; }
    [[nodiscard]] Ghost ghost() const;
};

// The text is that of `situation`, the motion that of `then`; they differ while a step is announced.
Hint make_hint(Situation situation, Situation then, int level, const Scene& scene);

// The control for each motion as text ("hold F and drag").
using Controls = std::array<std::string, motion_count>;

std::string say(const words::Words& words, const Hint& hint);
// The motion and its control as text; empty below level 3.
std::string say_motion(const words::Words& words, const Hint& hint, const Controls& controls);

// Describes, in the trainee's language, which input performs each motion of a hint. The caller names the
// bound keys and buttons.

// Mouse: press on a nut and hold, drag, release. `tool_key` takes the wrench and puts it down.
Controls mouse_controls(const words::Words& words, const std::string& tool_key);

// Force-feedback device: `button` closes the hand, `tool_key` puts the wrench down.
Controls device_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// Devices without force feedback: while `button` is held, the tool covers the last distance by itself.
Controls puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key);
Controls keyboard_controls(const words::Words& words, const std::string& button, const std::string& tool_key);

// Glove: `moved_by` moves the hand; the fingers do the rest.
Controls glove_controls(const words::Words& words, Controls moved_by);

// Selects hints over time: they become more explicit the longer the work makes no progress, and do not
// flicker.
//
//   guided:     text at once, then outline and arrow, then a ghost, then the animated motion
//   practice:   the same after a long time, or one level more for each request
//   assessment: none, also on request
//
// A hint stays for 1.5 s, unless the step changes, the trainee has to stop, or its request has been
// fulfilled.

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
