// Ticks on their way from the picture's thread to the speaker's, which makes them sound: neither waits.
//
// Ticks come in bursts, one a picture, and are needed evenly. What waits is heard a little faster the more of
// it there is, so that a burst is used up within some `behind`; speeds and forces are heard, not samples, so
// that no pitch rises with it. When none come, what goes on goes on for a moment, and then comes to rest.
#pragma once

#include <atomic>
#include <cstdint>

#include "engine/base/spsc_ring.hpp"
#include "game/sound/synth.hpp"

namespace bolt::sound {

// Outlives the speaker that it fills.
class Feed {
  public:
    static constexpr double behind = 0.04;    // s
    static constexpr double patience = 0.25;  // s without a tick
    static constexpr double stale = 0.5;      // s: what waited for longer is not heard any more

    Feed(Synth synth, double dt);

    // For one caller: who takes the ticks.
    void push(const Heard& heard);

    // For one other: the speaker's thread. Allocates nothing.
    void fill(std::span<float> samples);

    // Ticks that were never heard: nobody filled, or too late.
    [[nodiscard]] std::uint64_t lost() const { return lost_.load(std::memory_order_relaxed); }

  private:
    Synth synth_;
    double dt_;
    SpscRing<Heard> ticks_;
    double quiet_ = 0.0;  // s since a tick came
    double owed_ = 0.0;   // ticks, less than one
    std::atomic<std::uint64_t> lost_{0};
};

}  // namespace bolt::sound
