// Hints for the trainee: their texts and level of detail, the controls that they name, and their selection
// over time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/situation.hpp"

namespace bolt::lesson {

// The hand motion that a hint requests. It selects the arrow and the control to name.
enum class HintMotion : std::uint8_t {
    none,
    take,      // the wrench
    put_away,  // lay the wrench down
    approach,  // with the wrench
    reach,     // with the fingers
    set_on,    // put the wrench on the nut
    grip_nut,
    spin,        // turn the nut with the fingers
    twist_back,  // turn the empty hand back
    let_go,
    pull_on,       // pull the wrench in the tightening direction
    pull_off,      // pull the wrench in the loosening direction
    lift,          // take the wrench off the nut
    set_back,      // move the handle back for another stroke
    counter_hold,  // put the second wrench on the held part
};
inline constexpr std::size_t motion_count = 15;

enum class GhostKind : std::uint8_t { none, hand, hand_and_wrench };

struct Hint {
    Situation situation = Situation::all_done;
    // 0: text; 1: outline and arrow; 2: ghost, a translucent hand or wrench at the target pose; 3: animated
    // motion and its control.
    int level = 0;
    int joint = -1;  // the due joint; −1: none
    HintMotion motion = HintMotion::none;
    words::TextKey text = "hint.all_done";
    std::vector<words::TextArgument> arguments;

    [[nodiscard]] int outlined() const { return level >= 1 ? joint : -1; }
    [[nodiscard]] HintMotion arrow() const { return level >= 1 ? motion : HintMotion::none; }
    [[nodiscard]] GhostKind ghost() const;
};

// `situation` selects the text and `underlying` the motion. They differ in the first 3 s of a step:
// `situation` is then the announcement, and `underlying` is what to do, which gives the motion and its
// arrow.
Hint make_hint(Situation situation, Situation underlying, int level, const ObservedLesson& work);

// The control for each motion as text ("hold F and drag"); motion_text() replaces its placeholders.
using ControlNames = std::array<std::string, motion_count>;

std::string hint_text(const words::Words& words, const Hint& hint);
// The motion and its control as text; empty below level 3.
std::string motion_text(const words::Words& words, const Hint& hint, const ControlNames& controls);

// The following functions describe, in the trainee's language, which input performs each motion of a hint.
// The caller names the bound keys and buttons.

// Returns `controls` with `key` as the control of HintMotion::counter_hold. Use it at a window: the functions
// below name a button of the panel for this motion, and a panel exists only in a room.
ControlNames with_second_wrench(const words::Words& words, ControlNames controls, const std::string& key);

// The helped hand: press on a nut and hold, drag, release. `tool_key` takes the wrench and puts it down.
ControlNames mouse_controls(const words::Words& words, const std::string& tool_key);

// A free hand that the mouse drags.
ControlNames drag_controls(const words::Words& words, const std::string& tool_key);

// Force-feedback device: `button` closes the hand, `tool_key` puts the wrench down.
ControlNames device_controls(const words::Words& words, const std::string& button,
                             const std::string& tool_key);

// Devices without force feedback: while `button` is held, the tool covers the last distance by itself.
ControlNames puck_controls(const words::Words& words, const std::string& button, const std::string& tool_key);
// The keyboard in place of such a device.
ControlNames keyboard_controls(const words::Words& words, const std::string& button,
                               const std::string& tool_key);

// Glove or gripper: takes the controls of the device that moves the hand, and replaces those that the fingers
// perform.
ControlNames glove_controls(const words::Words& words, ControlNames controls);
// A hand that a headset tracks.
ControlNames tracked_controls(const words::Words& words);

// Hints become more explicit the longer the work makes no progress, and do not flicker.
//
//   guided:     text at once, then outline and arrow, then a ghost, then the animated motion
//   practice:   the same after a long time
//   assessment: none, also on request
//
// Except in an assessment, each request raises the level by one. A hint stays for at least 1.5 s. It is
// replaced earlier if the step changes, if the trainee has to stop or turns the wrong nut or the wrong way,
// or if the trainee has done what the hint requests.

// Time without progress after which each level is reached, s.
struct HintTimes {
    std::array<double, 4> level;
};
inline constexpr HintTimes guided_times{{0.0, 4.0, 9.0, 15.0}};
inline constexpr HintTimes practice_times{{20.0, 35.0, 50.0, 65.0}};

inline constexpr double min_hint_duration = 1.5;            // s
inline constexpr double min_duration_when_fulfilled = 0.5;  // s, once its request is fulfilled

// Progress of the hand towards the nut of a step.
enum class Reached : std::uint8_t { nothing, right_tool, tool_on_nut };

// The best values reached in a step; a new best is progress.
struct StepProgress {
    double torque = 0.0;  // N·m, highest in this step
    double angle = 0.0;   // rad, furthest in the step's direction
    // The next two members are reset when the hand releases a nut that it has moved.
    double distance = 1e9;  // m to the nut, smallest
    Reached reached = Reached::nothing;
    bool moved = false;  // the hand has moved the nut that it holds
    double idle = 0.0;   // s since the last progress
};

// The shown hint and the timing of its successor.
struct HintState {
    std::optional<Hint> shown;  // none: no hint is shown
    Situation shown_situation = Situation::all_done;
    double shown_for = 0.0;                     // s
    Situation candidate = Situation::all_done;  // situation of the last frame
    double candidate_for = 0.0;                 // s
    double differs_for = 0.0;                   // s for which `candidate` has differed from `shown_situation`
    Situation underlying = Situation::all_done;  // of the shown hint, as in make_hint()
    std::size_t step = SIZE_MAX;                 // Lesson::current in the last frame
    double step_time = 0.0;                      // s since the step began
    int pass = -1;                               // of that step
    bool new_pass = false;                       // that step is the first one of its pass
    int level = -1;                              // reached in this situation; −1: none yet
    int held_joint = -1;                         // Lesson::held_joint when the shown hint was made
    StepProgress progress;
};

// Advances by a frame of `dt` seconds and returns the hint to show. `requested`: the trainee requested help
// in this frame.
const std::optional<Hint>& update(HintState& hints, const ObservedLesson& work, double dt,
                                  bool requested = false);

}  // namespace bolt::lesson
