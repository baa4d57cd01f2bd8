#include "haptics/joint/nut.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace bolt;
using namespace bolt::joint;

namespace {

// A 24.2 mm jaw on an M16 nut, flats on flats over 10 mm.
CornerGrip whole() {
    const double side = 24e-3 / std::sqrt(12.0);
    return {10e-3, side, side, 0.0, 0.1e-3, 0.0};
}

}  // namespace

TEST_CASE("Corner: the pressure on a corner of 120 degrees lies between a column's and a punch's") {
    const double hardness = 3.0;  // for a flow stress of 1
    const double column = 2.0 / std::sqrt(3.0), punch = column * (1.0 + 0.5 * pi);
    CHECK(corner_pressure(hardness) == doctest::Approx(column * (1.0 + pi / 6.0)).epsilon(1e-12));
    CHECK(corner_pressure(hardness) > column);
    CHECK(corner_pressure(hardness) < punch);
}

TEST_CASE("Corner: the nut's hardness is the ISO 898-2 value for the bolt's property class") {
    const auto of = [](const char* name, double d) {
        return nut_hardness(property_class(name, d).value(), d) / 9.80665e6;
    };
    CHECK(of("4.6", 16e-3) == doctest::Approx(130.0));
    CHECK(of("8.8", 8e-3) == doctest::Approx(200.0));
    CHECK(of("8.8", 20e-3) == doctest::Approx(233.0));
    CHECK(of("10.9", 16e-3) == doctest::Approx(272.0));
    CHECK(of("12.9", 16e-3) == doctest::Approx(295.0));
    CHECK(nut_hardness(property_class("A2-70", 16e-3).value(), 16e-3) == doctest::Approx(2.1e9));
}

TEST_CASE(
    "Corner: half the overlap height gives half the torque, half the width a quarter, no overlap zero") {
    const double p = corner_pressure(130 * 9.80665e6);
    const double full = corner_torque(p, whole());
    // Closed form p e s²/12.
    CHECK(full == doctest::Approx(p * 10e-3 * square(24e-3) / 12.0).epsilon(1e-12));
    CHECK(full > 200.0);  // more than the joint's 78 N·m
    CornerGrip grip = whole();
    grip.height *= 0.5;
    CHECK(corner_torque(p, grip) == doctest::Approx(0.5 * full).epsilon(1e-12));
    grip = whole();
    grip.toward_mouth = 0.0;
    CHECK(corner_torque(p, grip) == doctest::Approx(0.25 * full).epsilon(1e-12));
    grip = whole();
    grip.rounded = 0.5 * grip.toward_throat;
    CHECK(corner_torque(p, grip) == doctest::Approx(0.25 * full).epsilon(1e-12));
    grip.height = 0.0;
    CHECK(corner_torque(p, grip) == 0.0);
    grip = whole();
    grip.toward_mouth = -1.0;
    CHECK(corner_torque(p, grip) == 0.0);
}

TEST_CASE("Corner: the torque falls continuously with the tilt of the jaw") {
    const double p = 1e9;
    CornerGrip grip = whole();
    const double full = corner_torque(p, grip);
    grip.tilt = std::atan(grip.clearance / grip.height);
    CHECK(corner_torque(p, grip) == doctest::Approx(full).epsilon(1e-9));
    grip.tilt = -std::atan(2.0 * grip.clearance / grip.height);
    CHECK(corner_torque(p, grip) == doctest::Approx(0.5 * full).epsilon(1e-9));
    double before = full;
    for (int i = 0; i < 1000; ++i) {
        grip.tilt = i * 1e-4;
        const double now = corner_torque(p, grip);
        REQUIRE(now <= before + 1e-9);
        REQUIRE(before - now < 0.02 * full);
        before = now;
    }
}

TEST_CASE("Corner: the backlash is exact for an intact nut and grows with the rounded corner") {
    const double w = 24.2e-3, s = 24e-3;
    const double whole_play = rounded_half_play(w, s, 0.0);
    CHECK(std::cos(whole_play) + std::sin(whole_play) / std::sqrt(3.0) ==
          doctest::Approx(w / s).epsilon(1e-12));
    double before = whole_play;
    for (int i = 1; i <= 52; ++i) {
        const double play = rounded_half_play(w, s, i * 0.1e-3);
        REQUIRE(play > before);
        before = play;
    }
    CHECK(rounded_half_play(w, s, 6e-3) == doctest::Approx(pi / 6));
    CHECK(rounded_half_play(23.9e-3, s, 0.0) == 0.0);
}
