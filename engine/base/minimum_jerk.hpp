// The minimum-jerk profile of a hand's reach.
#pragma once

#include <algorithm>

namespace bolt {

// The share of the way at the share `tau` of the time, clamped to 0 … 1: 10τ³ − 15τ⁴ + 6τ⁵, at rest at both
// ends. Flash and Hogan, J. Neurosci. 5 (1985) 1688.
inline double minimum_jerk(double tau) {
    const double t = std::clamp(tau, 0.0, 1.0);
    return t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

}  // namespace bolt
