// One hint: its text, how explicit it is, and what the view shows of it.
#pragma once

#include <array>
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

}  // namespace bolt::lesson
