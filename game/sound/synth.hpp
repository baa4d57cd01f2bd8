// The sound synthesiser: computes the sounds of the work sample by sample from cues (SoundCues), without
// recordings.
//
//   strike, click, slip, chimes   force pulses that excite resonators
//   tooth                         the same; no more than max_teeth sound in a second
//   slide                         band-pass noise whose frequency rises with the speed
//   run                           pulses, a fixed number per turn of the nut; a tone when they are fast
//   creep                         stick-slip: the nut sticks, then slips with a pulse
//
// All inputs are smoothed. A limiter keeps the output below 1, and a second one limits its slope (max_slope).
// The output depends only on the sequence of calls, not on the block size. No function but make_synth
// allocates.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>

#include "engine/base/random.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::sound {

// casing: large parts of cast iron. nut: small parts of steel (nuts, bolts, washers).
enum class StruckSurface : std::uint8_t { casing, nut };

// The audible quantities of one tick. detect_events (event_detection.hpp) derives them from the servo's
// output.
struct SoundCues {
    float strike_speed = 0.0F;  // m/s at which the wrench hits something in this tick; 0: no strike
    StruckSurface surface = StruckSurface::casing;
    float slide_speed = 0.0F;    // m/s of the wrench along the surface
    float contact_force = 0.0F;  // N of the wrench onto the surface

    float run_speed = 0.0F;    // rad/s of the unloaded nut on its thread, absolute
    float creep_speed = 0.0F;  // rad/s of the nut under load, absolute
    // 0 … 1.5: clamp force over 90 % of the force at which the bolt yields. With the published law, which has
    // no clamp force: torque over the greatest torque of the joint type.
    float load = 0.0F;

    float slip = 0.0F;     // 0 … 1.5: strength with which the jaw slips over the nut's corners in this tick
    bool click = false;    // the torque wrench clicks
    bool tooth = false;    // the pawl of a ratchet falls into a tooth
    bool done = false;     // chime: a step of a joint is done
    bool mistake = false;  // low chime: a mistake
};

struct ResonatorMode {
    double frequency = 0.0;  // Hz
    double decay = 0.0;      // s in which it fades to 1/e
    double level = 0.0;      // relative to the other modes
};

// A bank of damped resonators. A mode is a phasor that each sample rotates by its frequency and shrinks by
// its damping. The force adds to its real part; the output is its imaginary part, so it starts at zero and is
// continuous for any force (J. O. Smith, Physical Audio Signal Processing, on digital resonators).
class ResonatorBank {
  public:
    static constexpr std::size_t most = 6;  // modes; further ones are ignored

    ResonatorBank() = default;
    ResonatorBank(std::span<const ResonatorMode> modes, double rate);  // `rate`: Hz, of the samples

    // Applies the force of this sample and returns the output.
    double next(double force);

  private:
    struct Resonator {
        std::complex<double> state, rotation;
        double level = 0.0;
    };
    std::array<Resonator, most> resonators_{};
    std::size_t count_ = 0;
    bool rings_ = false;
};

// A squared half sine: the force between two bodies in an impact.
struct ForcePulse {
    double area = 0.0;               // over samples; 0: none
    double length = 1.0, age = 0.0;  // samples; a negative age is a delay

    double next();
};

// Pulses that may overlap. A pulse that does not fit in is dropped.
class ForcePulses {
  public:
    // `length`, `delay`: samples.
    void add(double area, double length, double delay = 0.0);
    double next();

  private:
    std::array<ForcePulse, 12> pulses_{};
    std::size_t count_ = 0;
};

// 1/s, limit of the output's slope: a quarter of full scale per sample at 48 kHz.
inline constexpr double max_slope = 12e3;
inline constexpr double max_teeth = 60.0;         // 1/s, limit of the teeth that sound; others are left out
inline constexpr double pulses_per_turn = 120.0;  // of the nut: sets the pitch of `run`

// First-order low-pass filter.
struct SmoothedValue {
    double value = 0.0, target = 0.0;
    double next(double share);  // `share` of the distance to the target per sample
};

struct Synth {
    double rate = 48000.0;       // Hz
    double smoothing = 0.0;      // share per sample, for SmoothedValue::next
    double crackle_decay = 0.0;  // factor per sample
    Random noise{1};

    // Struck bodies, and `creep` for the stick-slip, `ratchet` for clicks and teeth, the bells for `done`,
    // `gong` for `mistake`; each with the force pulses that excite it.
    ResonatorBank wrench, casing, nut, creep, ratchet, bell, second_bell, gong;
    ForcePulses wrench_pulses, casing_pulses, nut_pulses, creep_pulses, ratchet_pulses, bell_pulses,
        second_bell_pulses, gong_pulses;

    SmoothedValue slide_speed, contact_force;
    std::complex<double> scrape, scrape_rotation;  // band-pass filter: its state and its factor per sample
    double scrape_level = 0.0;

    SmoothedValue run_speed;
    double run_phase = 0.0;  // 0 … 1, from pulse to pulse

    SmoothedValue creep_speed, load;
    double stuck_angle = 0.0, release_angle = 0.0;  // rad since the nut began to stick; rad at which it slips

    double since_tooth = 1.0;  // s since the last tooth that sounded

    double crackle = 0.0;  // 0 … 1, level of the noise after a slip
    std::uint32_t sample_count = 0;
    double last_sample = 0.0;
};

Synth make_synth(const servo::Setup& setup, int rate, std::uint64_t seed = 1);

// Sets the cues for the following samples. Clamps each value to its range; a non-finite one counts as 0.
void apply_cues(Synth& synth, const SoundCues& cues);

// Lets all sounds fade out; for when no more ticks arrive.
void fade_out(Synth& synth);

// Computes the next samples, −1 … 1.
void render(Synth& synth, std::span<float> samples);

}  // namespace bolt::sound
