// What there is to be heard of one tick: plain numbers that ear.hpp reads off the servo's output and
// synth.hpp makes audible.
#pragma once

#include <cstdint>

namespace bolt::sound {

// Cast iron and big, or steel and small: nuts, bolts, washers.
enum class Met : std::uint8_t { casing, nut };

struct Heard {
    float strike = 0.0F;  // m/s, at which the wrench meets something in this tick; 0: it does not
    Met met = Met::casing;
    float slide = 0.0F;  // m/s along what it lies against
    float press = 0.0F;  // N onto it

    float run = 0.0F;    // rad/s of the nut on its thread, unloaded, either way
    float creep = 0.0F;  // rad/s of the nut under load, either way
    float load = 0.0F;   // 0 … 1.5: clamp force over 90 % of what makes the bolt yield

    float slip = 0.0F;     // 0 … 1.5: the jaw slips over the nut's corners in this tick, so hard
    bool click = false;    // of a torque wrench
    bool done = false;     // a chime: a joint is done
    bool mistake = false;  // a low one
};

}  // namespace bolt::sound
