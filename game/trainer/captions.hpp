// What sounds say, for those who do not hear them: read off the same numbers that are made audible. Pure; a
// caption stands long enough to be read and no longer, and what goes on is one caption, not many.
#pragma once

#include <array>
#include <vector>

#include "content/words/words.hpp"
#include "game/sound/sound_cues.hpp"

namespace bolt::trainer {

// What matters most first.
enum class Caption : std::uint8_t {
    slip,
    mistake,
    click,
    done,
    strike_casing,
    strike_nut,
    groan,
    scrape,
    run
};
inline constexpr std::size_t caption_count = 9;
inline constexpr std::size_t most_captions = 3;  // at once
inline constexpr double caption_stands = 2.0;    // s

struct Captions {
    std::array<double, caption_count> left{};   // s that each of them is still shown
    std::array<double, caption_count> heard{};  // 0 … 1, of what it takes until what goes on is said
};

// A tick of `dt` seconds.
void note(Captions& captions, const sound::Heard& heard, double dt);
// A frame has passed.
void update(Captions& captions, double seconds);
std::vector<Caption> shown(const Captions& captions);

words::Key term(Caption caption);

}  // namespace bolt::trainer
