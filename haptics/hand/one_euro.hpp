// The 1€ filter: a low-pass whose corner frequency rises with speed, so noise is suppressed at rest and lag
// in motion. Source: G. Casiez, N. Roussel, D. Vogel, 1€ filter: a simple speed-based low-pass filter for
// noisy input in interactive systems, CHI 2012.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::hand {

// At constant speed v the lag is below 1/(2π (at_rest + per_speed |v|)) s: with these values 6.5 ms at 1
// rad/s, the speed of a slow deliberate motion, and less at higher speed.
struct OneEuroOptions {
    double at_rest = 1.5;     // Hz, corner frequency at rest
    double per_speed = 15.0;  // Hz per rad/s
    double of_speed = 3.0;    // Hz, corner frequency of the speed filter
};

struct OneEuro {
    double value = 0.0, speed = 0.0;
    bool started = false;
};

// Smoothing factor of a first-order low-pass with this corner frequency (Hz) and time step dt (s).
inline double share(double corner, double dt) { return 1.0 / (1.0 + 1.0 / (2.0 * pi * corner * dt)); }

// Filters the value measured `dt` seconds (> 0) after the last one.
inline double filtered(OneEuro& filter, const OneEuroOptions& options, double value, double dt) {
    if (!filter.started) {
        filter = {value, 0.0, true};
        return value;
    }
    const double speed = (value - filter.value) / dt;
    filter.speed += share(options.of_speed, dt) * (speed - filter.speed);
    const double corner = options.at_rest + options.per_speed * std::abs(filter.speed);
    filter.value += share(corner, dt) * (value - filter.value);
    return filter.value;
}

}  // namespace bolt::hand
