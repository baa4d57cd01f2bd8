// ISO metric screw thread geometry (ISO 68-1 basic profile, ISO 724 basic dimensions).
#pragma once

#include "engine/base/math.hpp"

namespace bolt::joint {

// All lengths in metres, symbols as the standards write them.
struct Thread {
    double d = 0.0;      // nominal (major) diameter
    double pitch = 0.0;  // P
    double d2 = 0.0;     // pitch diameter, d − 0.64952 P
    double d3 = 0.0;     // minor diameter of the bolt, d − 1.22687 P
    double A_s = 0.0;    // tensile stress area, π/4 ((d2 + d3)/2)², m² (ISO 898-1)

    [[nodiscard]] double d0() const { return 0.5 * (d2 + d3); }        // diameter of the stress area
    [[nodiscard]] double A_d3() const { return 0.25 * pi * d3 * d3; }  // core section
    [[nodiscard]] double A_N() const { return 0.25 * pi * d * d; }     // nominal section
    [[nodiscard]] double lead_angle() const { return std::atan(pitch / (pi * d2)); }
};

inline constexpr double thread_half_angle = pi / 6.0;  // β, flank angle of the ISO profile

// Needs 0 < pitch and d − 1.22687 pitch > 0.
inline Thread metric_thread(double d, double pitch) {
    Thread t;
    t.d = d;
    t.pitch = pitch;
    t.d2 = d - 0.64952 * pitch;
    t.d3 = d - 1.22687 * pitch;
    t.A_s = 0.25 * pi * square(0.5 * (t.d2 + t.d3));
    return t;
}

}  // namespace bolt::joint
