// Writes a WAV file while its samples arrive: 16 bits, mono.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

#include "engine/base/result.hpp"

namespace bolt::audio {

// The file is named `path`.part until finish() renames it; without finish() the destructor removes it. So
// `path` is never incomplete. If `path` is a pipe or a device, it is written to directly, with the length
// 0xFFFFFFFF (unknown), which FFmpeg and others accept. After an error, every later call returns the same
// error.
class WavWriter {
  public:
    static Result<WavWriter> create(const std::filesystem::path& path, int rate);  // Hz
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

// The limit of the format's 32-bit lengths: more than twelve hours at 48,000 samples per second.
inline constexpr std::uint64_t max_wav_samples = (0xFFFFFFFFULL - 36) / 2;

}  // namespace bolt::audio
