// Angles of a hand that closes around a handle.
#pragma once

#include "engine/base/math.hpp"
#include "haptics/hand/angles.hpp"

namespace bolt::hand {

// `share` 0: open, the thumb opposite the fingers; 1: a fist. Values chosen within limits.hpp.
inline Angles closed_hand_angles(double share) {
    Angles a;
    const auto bent = [&](double degrees) { return share * to_radians(degrees); };
    for (FingerAngles& f : a.fingers) f = {bent(70.0), bent(95.0), bent(60.0), 0.0};
    a.thumb = {to_radians(70.0), to_radians(60.0) - bent(48.0), bent(50.0), bent(65.0)};
    a.arch = to_radians(8.0);
    return a;
}

}  // namespace bolt::hand
