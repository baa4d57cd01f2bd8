#include "haptics/joint/corner.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::joint {

namespace {

constexpr double pascals_per_vickers = 9.80665e6;
constexpr double wedge = 2.0 * pi / 3.0;  // between two flats

struct Hardness {
    std::string_view bolts;  // begin of their class
    double small, large;     // HV, up to M16 and above
};

// The first that fits.
constexpr Hardness table[] = {
    {"12.", 295, 272}, {"10.", 272, 272}, {"9.", 188, 188}, {"8.", 200, 233},
    {"6.", 150, 170},  {"5.", 130, 146},  {"4.", 130, 146},
};

}  // namespace

double nut_hardness(const PropertyClass& bolt_class, double d) {
    for (const Hardness& row : table)
        if (bolt_class.name.starts_with(row.bolts))
            return pascals_per_vickers * (d < 16.5e-3 ? row.small : row.large);
    return 3.0 * bolt_class.R_m;
}

double corner_pressure(double hardness) {
    const double flow = hardness / 3.0;
    return 2.0 / std::sqrt(3.0) * flow * (1.0 + wedge - 0.5 * pi);
}

double corner_torque(double pressure, const CornerGrip& g) {
    const double slope = std::tan(std::abs(g.tilt));
    const double height = slope * g.height > g.clearance ? g.clearance / slope : g.height;
    const double spread = 0.5 * (g.toward_throat + g.toward_mouth) - g.lost;
    return pressure * std::max(0.0, height) * square(std::max(0.0, spread));
}

double rounded_half_play(double opening, double across_flats, double lost) {
    // cos ψ s/2 + sin ψ x = w/2 with x = s/√12 - lost.
    const double half = 0.5 * across_flats;
    const double x = std::max(0.0, half / std::sqrt(3.0) - lost), reach = std::hypot(half, x);
    const double lean = std::atan2(x, half), c = 0.5 * opening / reach;
    return c >= 1.0 ? pi / 6.0 : std::max(0.0, lean - std::acos(c));
}

}  // namespace bolt::joint
