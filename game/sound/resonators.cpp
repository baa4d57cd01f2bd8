#include "game/sound/resonators.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::sound {

namespace {

constexpr double inaudible = 1e-7;  // of full scale, −140 dB: what is below stops

}  // namespace

Bank::Bank(std::span<const Tone> tones, double rate) {
    for (const Tone& tone : tones) {
        if (count_ == most || tone.frequency > 0.45 * rate) continue;
        Mode& mode = modes_[count_++];
        mode.turn = std::polar(std::exp(-1.0 / (tone.decay * rate)), 2.0 * pi * tone.frequency / rate);
        mode.level = tone.level;
    }
}

double Bank::next(double force) {
    if (!rings_ && force == 0.0) return 0.0;
    double sum = 0.0;
    double loudest = std::abs(force);
    for (std::size_t i = 0; i < count_; ++i) {
        Mode& m = modes_[i];
        const double re = m.state.real() * m.turn.real() - m.state.imag() * m.turn.imag() + force;
        const double im = m.state.real() * m.turn.imag() + m.state.imag() * m.turn.real();
        m.state = {re, im};
        sum += m.level * im;
        loudest = std::max({loudest, std::abs(re), std::abs(im)});
    }
    rings_ = loudest > inaudible;
    if (!rings_)
        for (Mode& m : modes_) m.state = 0.0;
    return sum;
}

double Pulse::next() {
    if (area == 0.0) return 0.0;
    age += 1.0;
    if (age <= 0.0) return 0.0;
    if (age >= length) {
        area = 0.0;
        return 0.0;
    }
    return area / length * (1.0 - std::cos(2.0 * pi * age / length));
}

void Pulses::add(double area, double length, double delay) {
    if (area == 0.0) return;
    for (Pulse& p : pulses_) {
        if (p.area != 0.0) continue;
        p = {area, std::max(length, 2.0), -std::floor(delay)};
        ++count_;
        return;
    }
}

double Pulses::next() {
    if (count_ == 0) return 0.0;
    double sum = 0.0;
    for (Pulse& p : pulses_) {
        if (p.area == 0.0) continue;
        sum += p.next();
        if (p.area == 0.0) --count_;
    }
    return sum;
}

}  // namespace bolt::sound
