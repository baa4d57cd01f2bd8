// What makes samples heard, for as long as it can: a sound card, or whatever a test puts in its place. One
// channel, at one rate, in blocks of one size; libraries below know how to change that for a card.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "engine/base/result.hpp"

namespace bolt::audio {

inline constexpr int rate = 48000;         // samples a second
inline constexpr std::size_t block = 480;  // samples: 10 ms
inline constexpr std::size_t in_queue =
    4;  // blocks that wait in a sink at most: 40 ms from being made to being heard

class Sink {
  public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    // Blocks that it takes now. An error, here and below: it is gone, and there will be no more from it.
    virtual Result<std::size_t> room() = 0;
    virtual Status play(std::span<const float, block> samples) = 0;
    virtual Status set_volume(double volume) = 0;  // 0 … 1
};

using OpenSink = std::function<Result<std::unique_ptr<Sink>>()>;

}  // namespace bolt::audio
