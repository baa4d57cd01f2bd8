// Sink: an output for audio samples, that is a sound card or a substitute in tests. Samples are mono, with
// one sample rate and one block size; the system's sound libraries convert them for the device.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "engine/base/result.hpp"

namespace bolt::audio {

inline constexpr int sample_rate = 48000;            // samples per second
inline constexpr std::size_t block_size = 480;       // samples: 10 ms
inline constexpr std::size_t max_queued_blocks = 4;  // 40 ms of latency

// Converts a sample in [-1, 1] to 16 bits, rounded. Values outside are clamped; NaN becomes silence.
inline std::int16_t to_pcm16(float sample) {
    if (std::isnan(sample)) return 0;
    return static_cast<std::int16_t>(std::lround(32767.0F * std::clamp(sample, -1.0F, 1.0F)));
}

class Sink {
  public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    // Returns how many blocks can be queued now. After an error of this function, play() or set_volume(), the
    // sink cannot be used any more.
    virtual Result<std::size_t> free_blocks() = 0;
    virtual Status play(std::span<const float, block_size> samples) = 0;  // queues a block
    virtual Status set_volume(double volume) = 0;                         // 0 … 1
};

using OpenSink = std::function<Result<std::unique_ptr<Sink>>()>;

// Opens the default sound output through OpenAL Soft (Debian 12 has version 1.19). Open, use and close it on
// one thread. The user's settings apply: ALSOFT_DRIVERS and alsoft.conf select PulseAudio, ALSA or others.
Result<std::unique_ptr<Sink>> open_openal();

}  // namespace bolt::audio
