#include "engine/base/random.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt {

Random::Random(std::uint64_t seed, std::uint64_t stream) : state_(0), increment_((stream << 1U) | 1U) {
    bits();
    state_ += seed;
    bits();
}

std::uint32_t Random::bits() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
    const auto rotation = static_cast<std::uint32_t>(old >> 59U);
    return (shifted >> rotation) | (shifted << ((32U - rotation) & 31U));
}

double Random::uniform() { return bits() * (1.0 / 4294967296.0); }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::normal() {
    // Box–Muller. The second value is discarded, so that the generator has no state besides PCG's.
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return std::clamp(radius * std::cos(2.0 * pi * uniform()), -3.0, 3.0);
}

}  // namespace bolt
