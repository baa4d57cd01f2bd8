#include "game/measure/butterworth.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::measure {

namespace {

struct Biquad {
    double b0, b1, b2, a1, a2;
};

const double two_pass_share = std::sqrt(2.0) - 1.0;

Biquad make_biquad(double cut_off, double rate) {
    const double w = std::tan(pi * cut_off / rate) / std::pow(two_pass_share, 0.25);
    const double norm = 1.0 / (1.0 + std::sqrt(2.0) * w + w * w);
    const double b0 = w * w * norm;
    return {b0, 2.0 * b0, b0, 2.0 * (w * w - 1.0) * norm, (1.0 - std::sqrt(2.0) * w + w * w) * norm};
}

// One pass in place, from the steady state of the first sample (direct form II, transposed).
void run_pass(const Biquad& f, std::vector<double>& x) {
    double z1 = x.front() * (1.0 - f.b0), z2 = x.front() * (f.b2 - f.a2);
    for (double& value : x) {
        const double in = value, out = f.b0 * in + z1;
        z1 = f.b1 * in - f.a1 * out + z2;
        z2 = f.b2 * in - f.a2 * out;
        value = out;
    }
}

}  // namespace

double low_pass_gain(double frequency, double cut_off, double rate) {
    const double ratio = std::tan(pi * frequency / rate) / std::tan(pi * cut_off / rate);
    return 1.0 / (1.0 + two_pass_share * square(square(ratio)));
}

std::vector<double> zero_phase_low_pass(std::span<const double> samples, double cut_off, double rate) {
    if (samples.size() < 2) return {samples.begin(), samples.end()};
    // Three periods of the cut-off: transients of the ends have decayed below 10⁻⁵ by then.
    const std::size_t n = samples.size();
    const auto pad =
        static_cast<std::size_t>(std::min(static_cast<double>(n - 1), std::ceil(3.0 * rate / cut_off)));
    std::vector<double> x;
    x.reserve(n + 2 * pad);
    for (std::size_t i = pad; i > 0; --i) x.push_back(2.0 * samples[0] - samples[i]);
    x.insert(x.end(), samples.begin(), samples.end());
    for (std::size_t i = 1; i <= pad; ++i) x.push_back(2.0 * samples[n - 1] - samples[n - 1 - i]);
    const Biquad filter = make_biquad(cut_off, rate);
    run_pass(filter, x);
    std::reverse(x.begin(), x.end());
    run_pass(filter, x);
    std::reverse(x.begin(), x.end());
    return {x.begin() + static_cast<std::ptrdiff_t>(pad), x.begin() + static_cast<std::ptrdiff_t>(pad + n)};
}

}  // namespace bolt::measure
