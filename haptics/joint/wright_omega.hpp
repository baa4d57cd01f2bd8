// The Wright omega function of a real argument: the ω with ω + ln ω = x.
#pragma once

#include <cmath>

namespace bolt::joint {

// Relative error below 1e-15 for every x; 0 where ω underflows. No loop: a starting value and two steps of
// the fourth-order iteration of Lawrence, Corless and Jeffrey, ACM Trans. Math. Softw. 38(3) (2012),
// algorithm 917.
inline double wright_omega(double x) {
    if (x < -36.0) return x < -700.0 ? 0.0 : std::exp(x);  // ω = e^x (1 − e^x + …)
    double w = 0.0;
    if (x < -2.0) {
        const double e = std::exp(x);
        w = e * (1.0 - e * (1.0 - 1.5 * e));
    } else if (x < 4.0) {
        const double z = x - 1.0;  // series about ω(1) = 1
        w = 1.0 + z * (0.5 + z * (1.0 / 16.0 - z * (1.0 / 192.0 + z * (1.0 / 3072.0))));
    } else {
        const double l = std::log(x);
        w = x - l + l / x;
    }
    for (int step = 0; step < 2; ++step) {
        const double r = x - w - std::log(w);
        const double w1 = 1.0 + w;
        const double t = 2.0 * w1 * (w1 + (2.0 / 3.0) * r);
        w *= 1.0 + (r / w1) * (t - r) / (t - 2.0 * r);
    }
    return w;
}

}  // namespace bolt::joint
