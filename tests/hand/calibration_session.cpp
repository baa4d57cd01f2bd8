#include "haptics/hand/glove_calibration.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::hand;

namespace {

// A person in a glove who takes the requested posture after a reaction time.
struct Trainee {
    CalibrationSession session;
    Random random{4};
    double now = 0.0;
    double noise = 0.5;     // counts
    double reaction = 0.8;  // s
    bool connected = true;
    int frames = 0;
    PerSensor<double> at{}, to{};

    static PerSensor<double> counts(Posture posture) {
        PerSensor<double> raw{};
        for (std::size_t i = 0; i < sensor_count; ++i)
            raw[i] = 60.0 + posture_angle(posture, static_cast<Sensor>(i)).value_or(0.2) / 0.013;
        return raw;
    }
    // Advances until another posture is requested, at most `most` seconds.
    void follow(double most) {
        const Posture asked = session.requested;
        const double from = now;
        while (now - from < most && session.requested == asked && session.phase != CalibrationPhase::done &&
               session.phase != CalibrationPhase::failed) {
            now += 0.0125;
            if (now - from > reaction) to = counts(asked);
            GloveFrame frame;
            for (std::size_t i = 0; i < sensor_count; ++i) {
                at[i] += 0.2 * (to[i] - at[i]);
                frame.raw[i] = static_cast<std::uint8_t>(
                    std::clamp(std::lround(at[i] + noise * random.normal()), 1L, 255L));
            }
            if (connected) ++frames;
            update(session, connected ? &frame : nullptr, now);
        }
    }
};

}  // namespace

TEST_CASE("CalibrationSession: four postures are requested and sampled, and the result has a score") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::spread);
    for (const Posture posture : {Posture::flat, Posture::fist, Posture::spread, Posture::thumb_across}) {
        CHECK(trainee.session.requested == posture);
        CHECK(std::string(prompt(posture)).size() > 20);
        trainee.follow(10.0);
    }
    REQUIRE(trainee.session.phase == CalibrationPhase::done);
    REQUIRE(trainee.session.result);
    CHECK(trainee.session.result->score > 0.5);
    CHECK(trainee.session.result->remarks.empty());
    const auto& fit = trainee.session.result->calibration.fits[index(Sensor::ring_pij)];
    REQUIRE(fit);
    CHECK(fit->gain == doctest::Approx(0.013).epsilon(0.02));
    for (const PostureSamples& held : trainee.session.taken) {
        CHECK(held.samples.size() > 150);
        for (const auto& sample : held.samples)  // none during the motion between postures
            CHECK(std::abs(sample[index(Sensor::middle_pij)] -
                           Trainee::counts(held.posture)[index(Sensor::middle_pij)]) < 10.0);
    }
}

TEST_CASE(
    "CalibrationSession: a trainee who stays in the last posture is waited for and advised after a while") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::flat);
    trainee.follow(10.0);
    CHECK(trainee.session.requested == Posture::fist);
    trainee.reaction = 1000.0;
    trainee.follow(19.0);
    CHECK(trainee.session.phase == CalibrationPhase::moving);
    CHECK(trainee.session.problem == CalibrationProblem::none);
    trainee.follow(2.0);
    CHECK(trainee.session.problem == CalibrationProblem::restless);
    CHECK(std::string(message_for(trainee.session.problem)).find("still") != std::string::npos);
    trainee.reaction = 0.5;
    trainee.follow(10.0);
    CHECK(trainee.session.requested == Posture::spread);
    CHECK(trainee.session.problem == CalibrationProblem::none);
}

TEST_CASE("CalibrationSession: motion or silence during sampling restarts the posture") {
    for (const bool silent : {false, true}) {
        Trainee trainee;
        trainee.reaction = 0.1;
        trainee.at = trainee.to = Trainee::counts(Posture::flat);
        while (trainee.session.phase != CalibrationPhase::holding) trainee.follow(0.05);
        trainee.follow(1.0);
        CHECK(trainee.session.held_for > 0.8);
        if (silent) {
            trainee.connected = false;
            trainee.follow(0.5);
            CHECK(trainee.session.problem == CalibrationProblem::silent);
            trainee.connected = true;
        } else {
            trainee.at[3] += 40.0;
        }
        trainee.follow(0.05);
        CHECK(trainee.session.phase == CalibrationPhase::moving);
        CHECK(trainee.session.held_for == 0.0);
        CHECK(trainee.session.taken.empty());
        trainee.follow(10.0);
        CHECK(trainee.session.requested == Posture::fist);
        CHECK(trainee.session.taken.size() == 1);
    }
}

TEST_CASE("CalibrationSession: a glove whose sensors hardly move fails or gets a low score") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::flat);
    trainee.follow(10.0);
    // Only one sensor moves, which is enough for the session to continue.
    for (int i = 0; i < 3; ++i) {
        trainee.reaction = 1000.0;
        trainee.to[index(Sensor::wrist_yaw)] += i % 2 == 0 ? 40.0 : -40.0;
        trainee.follow(10.0);
    }
    REQUIRE(trainee.session.phase == CalibrationPhase::done);
    CHECK(trainee.session.result->score == 0.0);
    CHECK(!trainee.session.result->remarks.empty());
}

TEST_CASE("CalibrationSession: a failure reports the error of the calibration") {
    CalibrationSession session;
    double now = 0.0;
    // Only the wrist is connected, and the postures define its angle for the flat hand only.
    for (int i = 0; i < 2000 && session.phase != CalibrationPhase::failed; ++i) {
        const bool odd = static_cast<int>(session.requested) % 2 != 0;
        GloveFrame frame;
        frame.raw[index(Sensor::wrist_yaw)] = odd ? 140 : 100;
        update(session, &frame, now += 0.0125);
    }
    REQUIRE(session.phase == CalibrationPhase::failed);
    REQUIRE(session.failure);
    CHECK(session.failure->message() ==
          "no sensor has readings in two postures; expected a glove whose finger sensors are connected");
}
