// A tick's samples after another's, for a file beside a video: as many as the ticks last, whole ones.
#pragma once

#include <cmath>
#include <vector>

#include "game/sound/synth.hpp"

namespace bolt::sound {

class Track {
  public:
    Track(Synth synth, double dt) : synth_(std::move(synth)), each_(synth_.rate * dt) {}

    // Valid until the next call.
    std::span<const float> next(const Heard& heard) {
        sound(synth_, heard);
        const double before = std::floor(each_ * static_cast<double>(ticks_));
        const double after = std::floor(each_ * static_cast<double>(++ticks_));
        samples_.resize(static_cast<std::size_t>(after - before));
        render(synth_, samples_);
        return samples_;
    }

  private:
    Synth synth_;
    double each_;
    std::uint64_t ticks_ = 0;
    std::vector<float> samples_;
};

}  // namespace bolt::sound
