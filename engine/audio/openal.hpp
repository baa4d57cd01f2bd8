// The default output of the machine through OpenAL Soft (version 1.19 is what Debian 12 has).
#pragma once

#include "engine/audio/sink.hpp"

namespace bolt::audio {

// To be opened, used and closed by one thread. What the user of the machine set up counts: ALSOFT_DRIVERS and
// alsoft.conf choose among PulseAudio, ALSA and others.
Result<std::unique_ptr<Sink>> open_openal();

}  // namespace bolt::audio
