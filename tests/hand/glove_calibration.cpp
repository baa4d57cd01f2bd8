#include "haptics/hand/glove_calibration.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

// A glove on a hand, with the response of each sensor to its angle.
struct Worn {
    PerSensor<LinearFit> sensor_fits;
    std::size_t sensors = 22;
    double noise = 0.0;  // counts

    explicit Worn(std::uint64_t seed) {
        Random random(seed, 1);
        for (auto& fit : sensor_fits) {
            fit.gain = random.uniform(0.011, 0.016);
            fit.offset = random.uniform(30.0, 60.0);
            if (random.uniform(0.0, 1.0) < 0.3) fit = {-fit.gain, 255.0 - fit.offset};
        }
    }
    [[nodiscard]] PostureSamples hold(Posture posture, std::uint64_t seed) const {
        Random random(seed, 2);
        PostureSamples held{posture, {}};
        for (int i = 0; i < 160; ++i) {
            PerSensor<std::uint8_t> raw{};
            for (const Sensor s : sensors_of(sensors)) {
                const LinearFit& fit = sensor_fits[index(s)];
                const double at = posture_angle(posture, s).value_or(random.uniform(0.0, 0.3));
                const double value = at / fit.gain + fit.offset + noise * random.normal();
                raw[index(s)] = static_cast<std::uint8_t>(std::clamp(std::lround(value), 1L, 255L));
            }
            held.samples.push_back(raw);
        }
        return held;
    }
    [[nodiscard]] std::vector<PostureSamples> all(std::uint64_t seed) const {
        return {hold(Posture::flat, seed), hold(Posture::fist, seed + 1), hold(Posture::spread, seed + 2),
                hold(Posture::thumb_across, seed + 3)};
    }
};

}  // namespace

TEST_CASE("GloveCalibration: four postures recover each sensor's fit within the quantisation") {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Worn worn(seed);
        worn.noise = 0.5;
        worn.sensors = seed % 2 == 0 ? 22 : 18;
        const Result<CalibrationResult> c = calibrate(worn.all(seed));
        REQUIRE(c);
        CHECK(c->remarks.empty());
        for (const Sensor s : sensors_of(worn.sensors)) {
            if (s == Sensor::wrist_pitch || s == Sensor::wrist_yaw)
                continue;  // no posture determines the wrist's sensors
            CAPTURE(std::string(name_of(s)));
            const auto& fit = c->calibration.fits[index(s)];
            REQUIRE(fit);
            for (const double at : {0.0, 0.5, 1.2}) {
                const double raw = at / worn.sensor_fits[index(s)].gain + worn.sensor_fits[index(s)].offset;
                // Rounding errors of half a count at both ends of the span.
                const double span = c->quality[index(s)].span;
                CHECK(std::abs(angle(*fit, raw) - at) <
                      std::abs(fit->gain) * (1.0 + 2.0 * std::abs(at / fit->gain) / span));
            }
        }
    }
}

TEST_CASE("GloveCalibration: the score falls with noise and with a small span, and the remarks give advice") {
    Worn worn(5);
    const double still = calibrate(worn.all(1))->score;
    worn.noise = 2.0;
    const double restless = calibrate(worn.all(1))->score;
    worn.noise = 8.0;
    const Result<CalibrationResult> shaking = calibrate(worn.all(1));
    CHECK(still > 0.5);
    CHECK(restless < still);
    CHECK(shaking->score < restless);
    REQUIRE(!shaking->remarks.empty());
    CHECK(shaking->remarks.back().find("hold still") != std::string::npos);

    worn.noise = 0.0;
    worn.sensor_fits[index(Sensor::ring_pij)].gain = 2.0;  // a sensor that does not bend with its finger
    const Result<CalibrationResult> loose = calibrate(worn.all(1));
    REQUIRE(loose);
    CHECK(loose->score == 0.0);
    REQUIRE(loose->remarks.size() == 1);
    CHECK(loose->remarks[0].find("ring PIJ") != std::string::npos);
    CHECK(!loose->calibration.fits[index(Sensor::ring_pij)]);
    CHECK(loose->calibration.fits[index(Sensor::ring_mpj)]);
}

TEST_CASE("GloveCalibration: outliers change nothing, because medians are used") {
    const Worn worn(7);
    std::vector<PostureSamples> held = worn.all(1);
    const CalibrationResult clean = *calibrate(held);
    for (PostureSamples& h : held)
        for (std::size_t i = 0; i < 20; ++i) h.samples[i * 7].fill(255);
    const CalibrationResult wild = *calibrate(held);
    for (std::size_t i = 0; i < sensor_count; ++i) {
        REQUIRE(clean.calibration.fits[i].has_value() == wild.calibration.fits[i].has_value());
        if (!clean.calibration.fits[i]) continue;
        CHECK(wild.calibration.fits[i]->gain == clean.calibration.fits[i]->gain);
        CHECK(wild.calibration.fits[i]->offset == clean.calibration.fits[i]->offset);
    }
}

TEST_CASE("GloveCalibration: missing postures are an error") {
    const Worn worn(3);
    const std::vector<PostureSamples> flat{worn.hold(Posture::flat, 1)};
    CHECK(calibrate(flat).error().message().find("\"fist\" is missing") != std::string::npos);
    std::vector<PostureSamples> empty{worn.hold(Posture::flat, 1), {Posture::fist, {}}};
    CHECK(calibrate(empty).error().message().find("no samples of the fist") != std::string::npos);
    empty[1].samples.resize(5);  // all zero: no sensor values
    CHECK(!calibrate(empty));
}
