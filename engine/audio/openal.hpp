// The default sound output through OpenAL Soft (Debian 12 has version 1.19).
#pragma once

#include "engine/audio/sink.hpp"

namespace bolt::audio {

// Open, use and close it on one thread. The user's settings apply: ALSOFT_DRIVERS and alsoft.conf select
// PulseAudio, ALSA or others.
Result<std::unique_ptr<Sink>> open_openal();

}  // namespace bolt::audio
