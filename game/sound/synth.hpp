// What there is to be heard of one tick: plain numbers that ear.hpp reads off the servo's output and
// synth.hpp makes audible.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>

#include "engine/base/random.hpp"
#include "haptics/servo/setup.hpp"

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

// Things that ring: a bank of damped modes, struck by short pulses of force.
//
// A mode is a phasor that turns by its frequency and shrinks by its damping with every sample; force adds to
// its real part, its imaginary part is heard. So whatever the force does, what is heard begins at zero and
// goes on without a step (J. O. Smith, Physical Audio Signal Processing, on digital resonators).

struct Tone {
    double frequency = 0.0;  // Hz
    double decay = 0.0;      // s in which it fades to 1/e
    double level = 0.0;      // of the bank
};

class Bank {
  public:
    static constexpr std::size_t most = 6;

    Bank() = default;
    Bank(std::span<const Tone> tones, double rate);

    // The next sample, with this force on it.
    double next(double force);

  private:
    struct Mode {
        std::complex<double> state, turn;
        double level = 0.0;
    };
    std::array<Mode, most> modes_{};
    std::size_t count_ = 0;
    bool rings_ = false;
};

// Half a sine squared: how two bodies press on each other while they bounce off.
struct Pulse {
    double area = 0.0;               // over samples; 0: none
    double length = 1.0, age = 0.0;  // samples; an age below zero: it is still to come

    double next();
};

// Some that may overlap. One more than there is room for is not heard.
class Pulses {
  public:
    void add(double area, double length, double delay = 0.0);
    double next();

  private:
    std::array<Pulse, 12> pulses_{};
    std::size_t count_ = 0;
};

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
