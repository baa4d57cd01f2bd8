#include "haptics/glove/calibration_session.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::glove;

namespace {

// Somebody in a glove, who does what is asked after a while.
struct Trainee {
    CalibrationSession session;
    Random random{4};
    double now = 0.0;
    double noise = 0.5;     // counts
    double reaction = 0.8;  // s
    bool connected = true;
    int frames = 0;
    BySensor<double> at{}, to{};

    static BySensor<double> counts(Posture posture) {
        BySensor<double> raw{};
        for (std::size_t i = 0; i < all_sensors; ++i)
            raw[i] = 60.0 + angle_in(posture, static_cast<Sensor>(i)).value_or(0.2) / 0.013;
        return raw;
    }
    // Until the posture that is asked is another one, or for so many seconds.
    void follow(double most) {
        const Posture asked = session.asked;
        const double from = now;
        while (now - from < most && session.asked == asked && session.phase != Phase::done &&
               session.phase != Phase::failed) {
            now += 0.0125;
            if (now - from > reaction) to = counts(asked);
            Frame frame;
            for (std::size_t i = 0; i < all_sensors; ++i) {
                at[i] += 0.2 * (to[i] - at[i]);
                frame.raw[i] = static_cast<std::uint8_t>(
                    std::clamp(std::lround(at[i] + noise * random.normal()), 1L, 255L));
            }
            if (connected) ++frames;
            go_on(session, connected ? &frame : nullptr, now);
        }
    }
};

}  // namespace

TEST_CASE("a session asks for four postures, takes each when it is held, and says how good it was") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::spread);
    for (const Posture posture : {Posture::flat, Posture::fist, Posture::spread, Posture::thumb_across}) {
        CHECK(trainee.session.asked == posture);
        CHECK(std::string(prompt(posture)).size() > 20);
        trainee.follow(10.0);
    }
    REQUIRE(trainee.session.phase == Phase::done);
    REQUIRE(trainee.session.result);
    CHECK(trainee.session.result->figure > 0.5);
    CHECK(trainee.session.result->remarks.empty());
    const auto& line = trainee.session.result->calibration.lines[index(Sensor::ring_pij)];
    REQUIRE(line);
    CHECK(line->gain == doctest::Approx(0.013).epsilon(0.02));
    for (const Held& held : trainee.session.taken) {
        CHECK(held.samples.size() > 150);
        for (const auto& sample : held.samples)  // none of those on the way
            CHECK(std::abs(sample[index(Sensor::middle_pij)] -
                           Trainee::counts(held.pose)[index(Sensor::middle_pij)]) < 10.0);
    }
}

TEST_CASE("who stays in the last posture is waited for, and told after a while") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::flat);
    trainee.follow(10.0);
    CHECK(trainee.session.asked == Posture::fist);
    trainee.reaction = 1000.0;
    trainee.follow(19.0);
    CHECK(trainee.session.phase == Phase::moving);
    CHECK(trainee.session.trouble == Trouble::none);
    trainee.follow(2.0);
    CHECK(trainee.session.trouble == Trouble::restless);
    CHECK(std::string(words(trainee.session.trouble)).find("still") != std::string::npos);
    trainee.reaction = 0.5;
    trainee.follow(10.0);
    CHECK(trainee.session.asked == Posture::spread);
    CHECK(trainee.session.trouble == Trouble::none);
}

TEST_CASE("a hand that moves, or a glove that falls silent, while a posture is held: it is taken anew") {
    for (const bool silent : {false, true}) {
        Trainee trainee;
        trainee.reaction = 0.1;
        trainee.at = trainee.to = Trainee::counts(Posture::flat);
        while (trainee.session.phase != Phase::holding) trainee.follow(0.05);
        trainee.follow(1.0);
        CHECK(trainee.session.held_for > 0.8);
        if (silent) {
            trainee.connected = false;
            trainee.follow(0.5);
            CHECK(trainee.session.trouble == Trouble::silent);
            trainee.connected = true;
        } else {
            trainee.at[3] += 40.0;
        }
        trainee.follow(0.05);
        CHECK(trainee.session.phase == Phase::moving);
        CHECK(trainee.session.held_for == 0.0);
        CHECK(trainee.session.taken.empty());
        trainee.follow(10.0);
        CHECK(trainee.session.asked == Posture::fist);
        CHECK(trainee.session.taken.size() == 1);
    }
}

TEST_CASE("a glove whose bends hardly move fails the session or its figure") {
    Trainee trainee;
    trainee.at = trainee.to = Trainee::counts(Posture::flat);
    trainee.follow(10.0);
    // Everything stays as it was but for one sensor, which lets the session go on.
    for (int i = 0; i < 3; ++i) {
        trainee.reaction = 1000.0;
        trainee.to[index(Sensor::wrist_yaw)] += i % 2 == 0 ? 40.0 : -40.0;
        trainee.follow(10.0);
    }
    REQUIRE(trainee.session.phase == Phase::done);
    CHECK(trainee.session.result->figure == 0.0);
    CHECK(!trainee.session.result->remarks.empty());
}
