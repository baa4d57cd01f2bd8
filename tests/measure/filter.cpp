// The zero-phase low pass against its closed form.
#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "engine/base/math.hpp"
#include "game/measure/butterworth.hpp"

namespace filter_test {

using namespace bolt;
using namespace bolt::measure;

TEST_CASE("Filter: a sine keeps its phase and has the gain of the closed form") {
    constexpr double rate = 1000.0, cut_off = 20.0;
    for (const double frequency : {2.0, 10.0, 20.0, 40.0}) {
        std::vector<double> samples(8000);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = std::sin(2.0 * pi * frequency * static_cast<double>(i) / rate);
        const std::vector<double> out = zero_phase_low_pass(samples, cut_off, rate);
        // Amplitudes in phase and out of phase over whole periods in the middle.
        double in_phase = 0.0, quadrature = 0.0;
        for (std::size_t i = 2000; i < 6000; ++i) {
            const double angle = 2.0 * pi * frequency * static_cast<double>(i) / rate;
            in_phase += out[i] * std::sin(angle) / 2000.0;
            quadrature += out[i] * std::cos(angle) / 2000.0;
        }
        CHECK(in_phase == doctest::Approx(low_pass_gain(frequency, cut_off, rate)).epsilon(1e-6));
        CHECK(std::abs(quadrature) < 1e-6);
    }
    CHECK(low_pass_gain(20.0, cut_off, rate) == doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
}

TEST_CASE("Filter: constants and straight lines pass unchanged up to the ends") {
    std::vector<double> line(400);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = 3.0 - 0.25 * static_cast<double>(i);
    const std::vector<double> out = zero_phase_low_pass(line, 10.0, 500.0);
    for (std::size_t i = 0; i < line.size(); ++i) CHECK(std::abs(out[i] - line[i]) < 1e-4);
    const std::vector<double> flat = zero_phase_low_pass(std::vector<double>(50, 7.0), 10.0, 500.0);
    for (const double v : flat) CHECK(v == doctest::Approx(7.0).epsilon(1e-12));
    CHECK(zero_phase_low_pass(std::vector<double>{1.5}, 10.0, 500.0) == std::vector<double>{1.5});
}

}  // namespace filter_test
