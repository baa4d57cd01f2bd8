// A low-pass that lets go when its value moves: still at rest, near the value in motion. G. Casiez, N.
// Roussel, D. Vogel, 1€ filter: a simple speed-based low-pass filter for noisy input in interactive systems,
// CHI 2012.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::glove {

// Of a value that moves at a constant speed v the filter lags by less than 1/(2π (at_rest + per_speed |v|))
// seconds: with these 6.5 ms at 1 rad/s, as slow as a finger moves on purpose, and less when it is faster.
struct OneEuroOptions {
    double at_rest = 1.5;     // Hz, corner of a value that does not move
    double per_speed = 15.0;  // Hz a rad/s
    double of_speed = 3.0;    // Hz, corner of the speed's own filter
};

struct OneEuro {
    double value = 0.0, speed = 0.0;
    bool started = false;
};

// Share of a new value that a low-pass with this corner (Hz) takes in after dt (s).
inline double share(double corner, double dt) { return 1.0 / (1.0 + 1.0 / (2.0 * pi * corner * dt)); }

// The value `dt` seconds (> 0) after the last one.
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

}  // namespace bolt::glove
