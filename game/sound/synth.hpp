// The sound of the work, made sample by sample from what there is to be heard: nothing is recorded, so the
// wrench sounds as long as it is.
//
//   strike, click, slip, chimes   pulses of force on things that ring (resonators.hpp)
//   slide                         noise in a band that rises with the speed
//   run                           a tone and ticks, so many a turn of the nut
//   creep                         stick and slip: winds up as the nut turns, and lets go
//
// All of it glides, passes a limiter that nothing gets through louder than 1, and one that lets no step
// through: `steepest`. The same calls give the same samples, in blocks of whatever size. No allocation.
#pragma once

#include <span>

#include "engine/base/random.hpp"
#include "game/sound/resonators.hpp"
#include "game/sound/sound_cues.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::sound {

// 1/s: a quarter of full scale from one sample to the next at 48 kHz.
inline constexpr double steepest = 12e3;
inline constexpr double marks_a_turn = 120.0;  // of the nut: the pitch of `run`

struct Glide {
    double now = 0.0, target = 0.0;
    double next(double share);
};

struct Synth {
    double rate = 48000.0;
    double follow = 0.0;  // share of the way that a glide goes in a sample
    double dies = 0.0;    // share of a crackle that is left after a sample
    Random noise{1};

    Bank wrench, casing, nut, groan, ratchet, bell, second_bell, gong;
    Pulses on_wrench, on_casing, on_nut, on_groan, on_ratchet, on_bell, on_second_bell, on_gong;

    Glide slide, press;
    std::complex<double> scrape, scrape_turn;
    double scrape_level = 0.0;

    Glide run;
    double phase = 0.0;  // of marks, 0 … 1

    Glide creep, load;
    double wound = 0.0, holds = 0.0;  // rad, and at which it lets go

    double crackle = 0.0;       // 0 … 1, what a slip leaves of noise in the nut
    std::uint32_t counted = 0;  // samples, for what is not computed at each
    double last = 0.0;          // sample
};

Synth make_synth(const servo::Setup& setup, int rate, std::uint64_t seed = 1);

// From the next sample on. Numbers that are none are not heard.
void sound(Synth& synth, const Heard& heard);

// Whatever goes on comes to rest: no ticks come any more.
void rest(Synth& synth);

void render(Synth& synth, std::span<float> samples);

}  // namespace bolt::sound
