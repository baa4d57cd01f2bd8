// Low-discrepancy points in the unit square: a pure function of pixel, seed and sample. Each pair of
// dimensions uses Sobol's first two dimensions, shuffled and scrambled with its own seed.
//   B. Burley, Practical Hash-based Owen Scrambling, JCGT 10(4), 2020.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <numbers>

#include "engine/shading/ggx.hpp"

namespace bolt::pathtrace {

using shading::radical_inverse;
using shading::reverse_bits;
using shading::unit_float;

inline constexpr float pi_float = std::numbers::pi_v<float>;

// Returns a hash of a pair with good avalanche (Murmur3's finalizer).
inline std::uint32_t hash(std::uint32_t a, std::uint32_t b) {
    std::uint32_t x = a ^ (b * 0x9E3779B9U + 0x7F4A7C15U);
    x ^= x >> 16U;
    x *= 0x85EBCA6BU;
    x ^= x >> 13U;
    x *= 0xC2B2AE35U;
    x ^= x >> 16U;
    return x;
}

// Owen scrambling by the hash of Laine and Karras.
inline std::uint32_t scramble(std::uint32_t x, std::uint32_t seed) {
    x = reverse_bits(x);
    x ^= x * 0x3D20ADEAU;
    x += seed;
    x *= (seed >> 16U) | 1U;
    x ^= x * 0x05526C56U;
    x ^= x * 0x53A22864U;
    return reverse_bits(x);
}

// Sobol's second dimension (the first is the radical inverse).
inline std::uint32_t sobol_second(std::uint32_t i) {
    std::uint32_t result = 0;
    for (std::uint32_t direction = 1U << 31U; i != 0; i >>= 1U, direction ^= direction >> 1U)
        if ((i & 1U) != 0U) result ^= direction;
    return result;
}

class SobolSampler {
  public:
    SobolSampler(std::uint32_t pixel, std::uint32_t seed, std::uint32_t sample)
        : seed_(hash(pixel, seed)), sample_(sample) {}

    // The next pair of dimensions.
    glm::vec2 pair() {
        const std::uint32_t seed = hash(seed_, dimension_++);
        const std::uint32_t index = scramble(sample_, seed);
        return {unit_float(scramble(reverse_bits(index), hash(seed, 1))),
                unit_float(scramble(sobol_second(index), hash(seed, 2)))};
    }

    float single() { return pair().x; }

  private:
    std::uint32_t seed_;
    std::uint32_t sample_;
    std::uint32_t dimension_ = 0;
};

}  // namespace bolt::pathtrace
