// Samples as cards and files take them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bolt::audio {

// −1 … 1 to 16 bits, rounded; what is beyond is cut off, what is no number is silence.
inline std::int16_t to_pcm16(float sample) {
    if (std::isnan(sample)) return 0;
    return static_cast<std::int16_t>(std::lround(32767.0F * std::clamp(sample, -1.0F, 1.0F)));
}

}  // namespace bolt::audio
