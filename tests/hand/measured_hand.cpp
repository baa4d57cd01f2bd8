#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/base/random.hpp"
#include "haptics/hand/measured_hand.hpp"
#include "tests/support/forbidden.hpp"

namespace hand_measured_hand_test {

using namespace bolt;
using namespace bolt::hand;

namespace {

constexpr double count = to_radians(0.75);  // rad per count of a sensor that spans 120° in 160 counts
constexpr double dt = 1.0 / 80.0;

// `value` rises monotonically. Returns the delay, s, with which the filtered value reaches `level`.
double lateness(const std::function<double(double)>& value, double level) {
    OneEuro filter;
    const auto reached = [&](const std::function<double(double)>& f) {
        double before = f(-0.5);
        for (double t = -0.5 + dt;; t += dt) {
            const double now = f(t);
            if (now >= level) return t - dt + dt * (level - before) / (now - before);
            before = now;
            if (t > 20.0) return t;
        }
    };
    const double of_value = reached(value);
    return reached([&](double t) { return filtered(filter, {}, value(t), dt); }) - of_value;
}

double deviation(const std::vector<double>& values) {
    double mean = 0.0, squares = 0.0;
    for (const double v : values) mean += v / static_cast<double>(values.size());
    for (const double v : values) squares += square(v - mean) / static_cast<double>(values.size());
    return std::sqrt(squares);
}

}  // namespace

TEST_CASE("OneEuro: the lag at constant speed matches the closed form, below 10 ms from 1 rad/s on") {
    for (const double speed : {1.0, 2.0, 5.0, 10.0}) {
        const OneEuroOptions options;
        // A low-pass lags by its time constant T. The filter estimates the speed from its own last value,
        // which lags by T, so the estimate is v (1 + T/dt). This gives a quadratic equation for T.
        const double a = options.cutoff_per_speed * speed / dt,
                     b = options.rest_cutoff + options.cutoff_per_speed * speed;
        const double expected = (std::sqrt(b * b + 4.0 * a / (2.0 * pi)) - b) / (2.0 * a);
        CHECK(expected < 7e-3);
        CHECK(expected < 1.0 / (2.0 * pi * b));
        OneEuro filter;
        double lag = 0.0;
        for (int i = 0; i < 200; ++i) lag = speed * i * dt - filtered(filter, options, speed * i * dt, dt);
        CHECK(lag / speed == doctest::Approx(expected).epsilon(1e-3));
    }
}

TEST_CASE("OneEuro: the lag during a hand movement stays below 10 ms from its first tenth on") {
    // Minimum jerk (Flash and Hogan, J. Neurosci. 5(7), 1985), a finger's half or whole bend.
    for (const double time : {0.25, 0.5, 1.0})
        for (const double bend : {1.0, 1.6})
            for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9}) {
                const auto move = [&](double t) {
                    const double s = std::clamp(t / time, 0.0, 1.0);
                    return bend * s * s * s * (10.0 + s * (6.0 * s - 15.0));
                };
                CAPTURE(time);
                CAPTURE(share);
                const double late = lateness(move, share * bend);
                CHECK(late < 10e-3);
                CHECK(late > 0.0);
            }
}

TEST_CASE("OneEuro: noise and quantisation at rest are at least halved") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        const double at = random.uniform(50.0, 200.0);
        OneEuro filter;
        std::vector<double> raw, out;
        for (int i = 0; i < 4000; ++i) {
            const double x = count * std::round(at + 0.5 * random.normal());
            const double y = filtered(filter, {}, x, dt);
            if (i < 80) continue;
            raw.push_back(x);
            out.push_back(y);
        }
        CHECK(deviation(raw) > 0.3 * count);
        CHECK(deviation(out) < deviation(raw) / 2.0);
    }
}

TEST_CASE(
    "HandAngles: a glove with 18 sensors gets its DIP angles, abductions add outward, unmeasured joints are "
    "0") {
    Calibration calibration;
    for (auto& fit : calibration.fits) fit = LinearFit{0.01, 100.0};
    calibration.fits[index(Sensor::wrist_pitch)].reset();
    GloveFrame frame;
    for (const Sensor s : sensors_of(18)) frame.raw[index(s)] = 110;  // 0.1 rad each
    frame.raw[index(Sensor::ring_pij)] = 190;
    const PerSensor<double> angles = sensor_angles(calibration, frame);
    CHECK(angles[index(Sensor::ring_dij)] == doctest::Approx(0.6));  // two thirds of 0.9
    CHECK(angles[index(Sensor::wrist_pitch)] == 0.0);
    const hand::Angles hand = hand_angles(angles);
    CHECK(hand.fingers[0].abduction == doctest::Approx(0.1));
    CHECK(hand.fingers[1].abduction == 0.0);
    CHECK(hand.fingers[2].abduction == doctest::Approx(0.1));
    CHECK(hand.fingers[3].abduction == doctest::Approx(0.2));
    CHECK(hand.fingers[2].pip == doctest::Approx(0.9));
    CHECK(hand.thumb.roll == doctest::Approx(0.1));
    frame.raw[index(Sensor::ring_dij)] = 150;  // a glove with 22 sensors measures it
    CHECK(sensor_angles(calibration, frame)[index(Sensor::ring_dij)] == doctest::Approx(0.5));
}

TEST_CASE("MeasuredHand: follows its frames, restarts after a gap, and stays within the limits") {
    GloveWearer wearer;
    wearer.hand = hand::make_hand(hand::Side::right);
    for (auto& fit : wearer.calibration.fits) fit = LinearFit{0.02, 100.0};
    GloveFrame frame;
    const auto all = [&](std::uint8_t raw) {
        for (const Sensor s : sensors_of(22)) frame.raw[index(s)] = raw;
    };
    MeasuredHand hand;
    all(100);
    update(hand, wearer, frame, 1.0);
    CHECK(hand.angles.fingers[1].mcp == 0.0);
    all(120);
    update(hand, wearer, frame, 1.0125);
    CHECK(hand.angles.fingers[1].mcp > 0.0);
    CHECK(hand.angles.fingers[1].mcp < 0.4);
    all(150);
    update(hand, wearer, frame, 2.0);  // after a gap of a second the last value is obsolete
    CHECK(hand.angles.fingers[1].mcp == doctest::Approx(1.0));
    update(hand, wearer, frame, 2.0);  // twice at the same time: no division by zero
    CHECK(std::isfinite(hand.angles.fingers[1].mcp));
    all(255);
    CHECK(test::forbidden_in([&] { update(hand, wearer, frame, 9.0); }).all() == 0);
    CHECK(hand.angles.fingers[1].pip < to_radians(121.0));
}

}  // namespace hand_measured_hand_test
