// The van der Corput sequence in base 2, which covers the unit interval evenly.
#pragma once

#include <cstdint>

namespace bolt::shading {

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16U) | (x >> 16U);
    x = ((x & 0x00FF00FFU) << 8U) | ((x & 0xFF00FF00U) >> 8U);
    x = ((x & 0x0F0F0F0FU) << 4U) | ((x & 0xF0F0F0F0U) >> 4U);
    x = ((x & 0x33333333U) << 2U) | ((x & 0xCCCCCCCCU) >> 2U);
    return ((x & 0x55555555U) << 1U) | ((x & 0xAAAAAAAAU) >> 1U);
}

// Uses 24 bits, so that the result as a float is below one.
inline float unit_float(std::uint32_t x) { return static_cast<float>(x >> 8U) * 0x1p-24F; }

inline float radical_inverse(std::uint32_t i) { return unit_float(reverse_bits(i)); }

}  // namespace bolt::shading
