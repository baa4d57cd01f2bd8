// Confidence bands over repetitions, RMSE, and errors of slope and breakaway, against closed forms.
#include "game/analysis/repetition.hpp"

#include <doctest/doctest.h>

#include "tests/analysis/curves.hpp"

namespace repetition_test {

using namespace bolt;
using namespace bolt::analysis;

namespace {

CycleComparison cycle_of(double mape, std::size_t count, double rmse) {
    CycleComparison cycle;
    cycle.errors.all = {count, 0, mape, mape, rmse};
    return cycle;
}

}  // namespace

TEST_CASE("Errors: the RMSE of a constant difference is the difference, below the floor too") {
    const auto straight = [](double degrees) { return degrees; };
    TorqueCurve measured = curve_of(straight, 0.0, 80.0, 0.5, joint::Direction::tighten), shifted = measured;
    for (double& torque : shifted.torque) torque += 0.25;
    const TorqueErrors errors = torque_errors(shifted, measured, 0.0, 10.0);
    CHECK(errors.all.rmse == doctest::Approx(0.25));
    CHECK(errors.all.below == 20);
    CHECK(errors.stage[0].count == 0);
    CHECK(errors.stage[0].rmse == doctest::Approx(0.25));
    const TorqueErrors pooled = pool(errors, torque_errors(measured, measured, 0.0, 10.0));
    CHECK(pooled.all.rmse == doctest::Approx(0.25 / std::sqrt(2.0)));
}

TEST_CASE("Errors: the slope error of two straight lines") {
    const auto line = [](double slope) { return [slope](double degrees) { return slope * degrees; }; };
    const TorqueCurve measured = curve_of(line(2.0), 0.0, 45.0, 0.5, joint::Direction::tighten);
    const TorqueCurve simulated = curve_of(line(1.5), 0.0, 45.0, 0.25, joint::Direction::tighten);
    CHECK(slope_error(simulated, measured, 0.0) == doctest::Approx(-0.25));
    CHECK(slope_error(simulated, measured, to_radians(3.0)) == doctest::Approx(-0.25));
    CHECK(std::isnan(slope_error(simulated, measured, to_radians(300.0))));
}

TEST_CASE("Errors: the breakaway error is relative to the measured peak") {
    const TorqueCurve simulated = curve_of(loosening_torque, 0.0, 90.0, 0.5, joint::Direction::loosen);
    TorqueCurve measured = simulated;
    for (double& torque : measured.torque) torque *= 1.25;
    const auto joint = compare_joint("B1", simulated, {{"1", measured}});
    REQUIRE(joint);
    CHECK(joint->cycles[0].breakaway_error == doctest::Approx(-0.2));
    CHECK(std::isnan(joint->cycles[0].slope_error));
}

TEST_CASE("Bands: equal repetitions have an interval of no width; fewer than four have none") {
    std::vector<CycleComparison> cycles(3, cycle_of(0.1, 10, 2.0));
    CHECK(std::isnan(repetition_bands(cycles).all.mape.low));
    cycles.resize(6, cycle_of(0.1, 10, 2.0));
    const RepetitionBands bands = repetition_bands(cycles);
    CHECK(bands.all.mape.low == doctest::Approx(0.1));
    CHECK(bands.all.mape.high == doctest::Approx(0.1));
    CHECK(bands.all.rmse.high == doctest::Approx(2.0));
    CHECK(std::isnan(bands.slope_error));
}

TEST_CASE("Bands: the interval is that of the mean, and it is repeatable") {
    // A half of the repetitions has 0, the other 2: the standard error of the mean of 100 is 0.1.
    std::vector<CycleComparison> cycles;
    for (int i = 0; i < 100; ++i) {
        cycles.push_back(cycle_of(i % 2 == 0 ? 0.0 : 2.0, 10, 1.0));
        cycles.back().slope_error = i % 2 == 0 ? -1.0 : 1.0;
    }
    const RepetitionBands bands = repetition_bands(cycles), again = repetition_bands(cycles);
    CHECK(bands.all.mape.low == doctest::Approx(1.0 - 1.96 * 0.1).epsilon(0.03));
    CHECK(bands.all.mape.high == doctest::Approx(1.0 + 1.96 * 0.1).epsilon(0.03));
    CHECK(bands.slope_error == doctest::Approx(0.0));
    CHECK(bands.slope_interval.high == doctest::Approx(0.196).epsilon(0.1));
    CHECK(bands.all.mape.low == again.all.mape.low);
}

TEST_CASE("Bands: the mean curve lies at the mean of shifted repetitions") {
    std::vector<MeasuredCurve> measured;
    std::vector<CycleComparison> cycles;
    for (int i = 0; i < 5; ++i) {
        TorqueCurve curve = curve_of(tightening_torque, 0.0, 80.0, 0.5, joint::Direction::tighten);
        for (double& angle : curve.angle) angle += to_radians(i);
        for (double& torque : curve.torque) torque += 0.1 * (i - 2);
        measured.push_back({std::to_string(i), curve});
        cycles.emplace_back();
        cycles.back().alignment.shift = -to_radians(i);
    }
    const CurveBand band = curve_band(measured, cycles);
    REQUIRE(!band.angle.empty());
    for (std::size_t i = 0; i < band.angle.size(); ++i) {
        CHECK(band.mean[i] == doctest::Approx(tightening_torque(to_degrees(band.angle[i]))).epsilon(0.01));
        CHECK(band.low[i] < band.mean[i]);
        CHECK(band.high[i] > band.mean[i]);
        CHECK(band.high[i] - band.low[i] < 0.4);
    }
    measured.resize(3);
    CHECK(curve_band(measured, cycles).angle.empty());
}

}  // namespace repetition_test
