// A WAV file that is written as its samples come, however many: 16 bits, one channel.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "engine/base/result.hpp"

namespace bolt::audio {

// Until finish() it is `path`.part, and gone with the writer: no half a file ever has the name. What is no
// regular file (a pipe to a program that makes videos) is written to as it is, its length said as "unknown",
// which FFmpeg and others take. After an error every later call gives it again.
class WavWriter {
  public:
    static Result<WavWriter> create(const std::filesystem::path& path, int rate);
    WavWriter(WavWriter&& other) noexcept;
    WavWriter& operator=(WavWriter&& other) noexcept;
    ~WavWriter();

    Status write(std::span<const float> samples);
    Status finish();

  private:
    struct State;
    explicit WavWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Samples that the format's 32-bit lengths have room for: at 48,000 a second more than twelve hours.
inline constexpr std::uint64_t most_wav_samples = (0xFFFFFFFFULL - 36) / 2;

}  // namespace bolt::audio
