// The screen's encoding of colours (IEC 61966-2-1), undone.
#pragma once

#include <cmath>
#include <glm/vec4.hpp>

namespace bolt::render {

inline float linear(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

// Alpha is not encoded.
inline glm::vec4 linear(const glm::vec4& encoded) {
    return {linear(encoded.r), linear(encoded.g), linear(encoded.b), encoded.a};
}

}  // namespace bolt::render
