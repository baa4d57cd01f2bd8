// Landmarks of curves whose landmarks are known.
#include "game/measure/landmarks.hpp"

#include "engine/base/math.hpp"
#include "haptics/joint/group.hpp"
#include "tests/measure/support.hpp"

namespace landmarks_test {

using namespace measure_test;
using measure::Landmarks;

namespace {

Landmarks landmarks_of(const std::function<double(double)>& torque, double to, double step, double noise,
                       joint::Direction direction = joint::Direction::tighten) {
    std::vector<double> angles, torques;
    Random random(5);
    for (double at = 0.0; at <= to + 1e-9; at += step) {
        angles.push_back(to_radians(at));
        torques.push_back(torque(at) + noise * random.normal());
    }
    return measure::find_landmarks(analysis::make_torque_curve(angles, torques, direction));
}

}  // namespace

TEST_CASE("Landmarks: a curve of three lines, with and without noise") {
    for (const double noise : {0.0, 0.1, 0.3}) {
        CAPTURE(noise);
        const Landmarks l = landmarks_of(known_torque, 140.0, 0.25, noise);
        REQUIRE(l.free);
        CHECK(l.free->mean == doctest::Approx(0.5).epsilon(0.01 + 0.2 * noise));
        CHECK(l.free->deviation == doctest::Approx(noise).epsilon(0.1));
        CHECK(to_degrees(l.free->end) < 100.0);
        REQUIRE(l.linear);
        CHECK(to_radians(l.linear->slope) == doctest::Approx(2.0).epsilon(0.02));
        CHECK(std::abs(to_degrees(*l.seat) - 100.0) < 0.15);
        CHECK(std::abs(to_degrees(l.linear->begin) - 100.0) < 2.0);
        CHECK(std::abs(to_degrees(l.linear->end) - 115.0) < 2.0);
        REQUIRE(l.yield);
        CHECK(std::abs(to_degrees(l.yield->angle) - 115.0) < 2.5);
    }
}

TEST_CASE("Landmarks: the standard error covers the slope") {
    const Landmarks l = landmarks_of(known_torque, 114.0, 0.1, 0.2);
    REQUIRE(l.linear);
    CHECK(std::abs(to_radians(l.linear->slope) - 2.0) < 3.0 * to_radians(l.linear->slope_error));
    CHECK(to_radians(l.linear->slope_error) < 0.01);
    CHECK_FALSE(l.yield);
}

TEST_CASE("Landmarks: the published law has its printed slope, seat and yield") {
    const joint::PublishedParameters p;
    joint::CurveOptions options;
    const auto samples = joint::torque_angle_curve(joint::make_published_group({p}), options);
    std::vector<double> angles, torques;
    for (const joint::CurveSample& s : samples) {
        angles.push_back(s.angle);
        torques.push_back(s.torque);
    }
    const Landmarks l =
        measure::find_landmarks(analysis::make_torque_curve(angles, torques, joint::Direction::tighten));
    REQUIRE(l.linear);
    CHECK(to_radians(l.linear->slope) == doctest::Approx(joint::published_linear_slope(p)).epsilon(0.01));
    const joint::PublishedBoundaries b = joint::published_boundaries(p);
    REQUIRE(l.yield);
    CHECK(std::abs(to_degrees(l.yield->angle) - b.yield) < 1.0);
    CHECK(to_degrees(*l.seat) == doctest::Approx(b.linearity).epsilon(0.001));
}

TEST_CASE("Landmarks: a few coarse samples") {
    const Landmarks l = landmarks_of(known_torque, 114.0, 2.5, 0.0);
    REQUIRE(l.linear);
    CHECK(to_radians(l.linear->slope) == doctest::Approx(2.0).epsilon(0.02));
    const Landmarks none = landmarks_of(known_torque, 114.0, 8.0, 0.0);
    CHECK_FALSE(none.linear);
    CHECK(none.missing.find("samples between 10 % and 90 %") != std::string::npos);
}

TEST_CASE("Landmarks: loosening has a breakaway, a release and free turning") {
    const auto torque = [](double d) { return -0.1 - 20.0 * std::exp(-d / 10.0); };
    const Landmarks l = landmarks_of(torque, 200.0, 1.0, 0.0, joint::Direction::loosen);
    CHECK(l.peak.torque == doctest::Approx(-20.1));
    REQUIRE(l.released);
    // 0.1 + 20 e^(−d/10) = 5 % of 20.1
    CHECK(std::abs(to_degrees(*l.released) - 10.0 * std::log(20.0 / 0.905)) < 1.0);
    REQUIRE(l.free);
    CHECK(l.free->mean == doctest::Approx(-0.15).epsilon(0.3));
    CHECK_FALSE(l.linear);
    CHECK_FALSE(landmarks_of(torque, 10.0, 1.0, 0.0, joint::Direction::loosen).released);
}

TEST_CASE("Landmarks: curves without a rise have none") {
    CHECK_FALSE(landmarks_of([](double) { return 1.0; }, 50.0, 1.0, 0.0).linear);
    CHECK_FALSE(landmarks_of([](double) { return -1.0; }, 50.0, 1.0, 0.0).linear);
    CHECK(measure::find_landmarks({}).missing == "there are no samples");
}

}  // namespace landmarks_test
