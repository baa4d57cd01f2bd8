// Things that ring: a bank of damped modes, struck by short pulses of force.
//
// A mode is a phasor that turns by its frequency and shrinks by its damping with every sample; force adds to
// its real part, its imaginary part is heard. So whatever the force does, what is heard begins at zero and
// goes on without a step (J. O. Smith, Physical Audio Signal Processing, on digital resonators).
#pragma once

#include <array>
#include <complex>
#include <span>

namespace bolt::sound {

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

}  // namespace bolt::sound
