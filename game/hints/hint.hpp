// One hint: what is said, how explicit it is, and what is shown of it in the view.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/hints/situation.hpp"

namespace bolt::hints {

// The hand's motion that a hint asks for: which arrow is drawn, and what a key or button does.
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

// What is said is `situation`; the motion is that of `then`, which is another while a step is announced.
Hint make_hint(Situation situation, Situation then, int level, const Scene& scene);

// What is pressed or moved for each motion, in words ("hold F and drag"), by who has bound the keys.
using Controls = std::array<std::string, motion_count>;

std::string say(const words::Words& words, const Hint& hint);
// The motion in words; empty below level 3.
std::string say_motion(const words::Words& words, const Hint& hint, const Controls& controls);

}  // namespace bolt::hints
