#include "game/analysis/comparison.hpp"

#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "tests/analysis/curves.hpp"

using namespace bolt;
using namespace bolt::analysis;
using joint::Direction;

TEST_CASE("Align: finds the shift of a tightening curve") {
    const analysis::TorqueCurve simulated = curve_of(tightening_torque, 0.0, 95.0, 0.05, Direction::tighten);
    for (const double shift : {-20.0, 0.0, 13.7, 42.0}) {
        for (const double step : {0.1, 1.0, 2.5}) {
            const analysis::TorqueCurve measured =
                curve_of(tightening_torque, shift, 95.0, step, Direction::tighten);
            const Result<Alignment> a = align(simulated, measured);
            REQUIRE(a);
            // Both curves count from their own start; the measured one starts at `shift`.
            CHECK(to_degrees(a->shift) == doctest::Approx(shift).epsilon(1e-9).scale(step / 1e-9));
            CHECK(std::abs(to_degrees(a->shift) - shift) <= step);
        }
    }
}

TEST_CASE("Align: uses the common torque range, so a run that stops early aligns too") {
    const analysis::TorqueCurve simulated = curve_of(tightening_torque, 0.0, 95.0, 0.05, Direction::tighten);
    const analysis::TorqueCurve measured = curve_of(tightening_torque, 10.0, 75.0, 0.5, Direction::tighten);
    const Result<Alignment> a = align(simulated, measured);
    REQUIRE(a);
    CHECK(a->torque == doctest::Approx(0.5 * measured.torque.back()));
    CHECK(std::abs(to_degrees(a->shift) - 10.0) <= 0.5);
}

TEST_CASE("Align: strokes and re-grips do not move the common point") {
    const auto at_nut = [](double nut) { return tightening_torque(nut); };
    std::vector<double> angle, torque;
    for (double from = 5.0; from < 95.0; from += 15.0) {
        for (int i = 0; i <= 10; ++i) {  // loading while the nut sticks
            angle.push_back(to_radians(from));
            torque.push_back(1.15 * at_nut(from) * i / 10.0);
        }
        for (double nut = from; nut < from + 15.0; nut += 0.25) {
            angle.push_back(to_radians(nut));
            torque.push_back(at_nut(nut));
        }
        angle.push_back(angle.back());
        torque.push_back(0.0);
    }
    const analysis::TorqueCurve measured = analysis::make_torque_curve(angle, torque, Direction::tighten);
    CHECK(measured.skipped >= 60);
    const analysis::TorqueCurve simulated = curve_of(tightening_torque, 0.0, 94.0, 0.05, Direction::tighten);
    const Result<Alignment> a = align(simulated, measured);
    REQUIRE(a);
    CHECK(std::abs(to_degrees(a->shift) - 5.0) <= 0.25);
}

TEST_CASE("Align: loosening curves meet at their breakaway") {
    const analysis::TorqueCurve simulated = curve_of(loosening_torque, 0.0, 90.0, 0.05, Direction::loosen);
    // The rig has 31.9° of play before the nut breaks loose.
    const auto rig = [](double degrees) {
        return degrees < 0.0 ? -5.02 * std::exp(degrees / 4.0) : loosening_torque(degrees);
    };
    const analysis::TorqueCurve measured = curve_of(rig, -31.9, 200.0, 5.32, Direction::loosen);
    const Result<Alignment> a = align(simulated, measured);
    REQUIRE(a);
    CHECK(std::abs(to_degrees(a->shift) + 31.9) <= 5.32);
    CHECK(a->torque == *std::min_element(measured.torque.begin(), measured.torque.end()));
}

TEST_CASE("Align: torque noise of 0.5 N m moves the shift by at most one sample") {
    Random random(5);
    const analysis::TorqueCurve simulated = curve_of(tightening_torque, 0.0, 95.0, 0.05, Direction::tighten);
    for (int round = 0; round < 50; ++round) {
        analysis::TorqueCurve measured = curve_of(tightening_torque, 20.0, 95.0, 1.0, Direction::tighten);
        for (double& torque : measured.torque) torque += 0.5 * random.normal();
        const Result<Alignment> a = align(simulated, measured);
        REQUIRE(a);
        CHECK(std::abs(to_degrees(a->shift) - 20.0) <= 1.0);
    }
}

TEST_CASE("Align: curves without a common torque are refused") {
    const analysis::TorqueCurve simulated = curve_of(tightening_torque, 0.0, 95.0, 0.05, Direction::tighten);
    CHECK_FALSE(align(simulated, {}));
    CHECK_FALSE(align({}, simulated));
    const analysis::TorqueCurve slack =
        curve_of([](double) { return -0.1; }, 0.0, 95.0, 0.05, Direction::tighten);
    CHECK_FALSE(align(slack, simulated));
}
