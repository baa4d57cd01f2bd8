#include "game/analysis/comparison.hpp"

#include <doctest/doctest.h>

#include "tests/analysis/curves.hpp"

using namespace bolt;
using namespace bolt::analysis;
using joint::Direction;

TEST_CASE("Torque errors: 10 % above the measured torque is 0.1 in every stage") {
    const analysis::TorqueCurve measured = curve_of(tightening_torque, 0.0, 95.0, 0.37, Direction::tighten);
    const analysis::TorqueCurve ours =
        curve_of([](double at) { return 1.1 * tightening_torque(at); }, 0.0, 95.0, 0.01, Direction::tighten);
    const TorqueErrors errors = torque_errors(ours, measured, 0.0, 0.0);
    std::size_t count = 0;
    for (const StageError& stage : errors.stage) {
        CHECK(stage.count > 5);
        CHECK(stage.mre == doctest::Approx(0.1).epsilon(1e-3));
        CHECK(stage.mape == doctest::Approx(0.1).epsilon(1e-3));
        count += stage.count;
    }
    CHECK(count == measured.size());
    CHECK(errors.all.count == count);
    CHECK(errors.outside == 0);
}

TEST_CASE("Torque errors: a curve against itself has none, in either direction") {
    for (const Direction direction : {Direction::tighten, Direction::loosen}) {
        const auto torque = direction == Direction::tighten ? tightening_torque : loosening_torque;
        const analysis::TorqueCurve curve = curve_of(torque, 0.0, 90.0, 0.1, direction);
        const TorqueErrors errors = torque_errors(curve, curve, 0.0, 0.0);
        CHECK(errors.all.count == curve.size());
        CHECK(errors.all.mre < 1e-9);
    }
}

TEST_CASE("Torque errors: maximum and mean match a hand calculation") {
    analysis::TorqueCurve ours;
    ours.angle = {0.0, 1.0, 2.0, 3.0};
    ours.torque = {1.0, 2.0, 3.0, 4.0};
    ours.stage = {joint::Stage::navigation, joint::Stage::navigation, joint::Stage::linearity,
                  joint::Stage::linearity};
    analysis::TorqueCurve measured;
    measured.angle = {0.5, 1.5, 2.0, 2.5};
    measured.torque = {1.0, 5.0, 2.0, 4.0};
    const TorqueErrors errors = torque_errors(ours, measured, 0.0, 0.0);
    // Ours at 0.5 and 1.5: 1.5 and 2.5; at 2 and 2.5: 3 and 3.5.
    CHECK(errors.stage[0].mre == doctest::Approx(0.5));
    CHECK(errors.stage[0].mape == doctest::Approx(0.5));
    CHECK(errors.stage[2].mre == doctest::Approx(0.5));
    CHECK(errors.stage[2].mape == doctest::Approx(0.5 * (0.5 + 0.125)));
    CHECK(std::isnan(errors.stage[1].mre));
    CHECK(errors.all.mape == doctest::Approx((0.5 + 0.5 + 0.5 + 0.125) / 4.0));
}

TEST_CASE("Torque errors: samples below the floor and outside the curve are excluded and counted") {
    analysis::TorqueCurve ours;
    ours.angle = {1.0, 2.0};
    ours.torque = {1.0, 2.0};
    ours.stage = {joint::Stage::transition, joint::Stage::transition};
    analysis::TorqueCurve measured;
    measured.angle = {0.0, 1.0, 1.5, 2.0, 2.5};
    measured.torque = {9.0, 0.0, 0.004, 2.0, 9.0};
    const TorqueErrors errors = torque_errors(ours, measured, 0.0, 0.01);
    CHECK(errors.outside == 2);
    CHECK(errors.stage[1].below == 2);
    CHECK(errors.stage[1].count == 1);
    CHECK(errors.all.mre == doctest::Approx(0.0));
    // Without a floor a zero torque is still excluded.
    CHECK(torque_errors(ours, measured, 0.0, 0.0).all.below == 1);
    CHECK(share_of_peak(measured) == doctest::Approx(0.09));
}

TEST_CASE("Torque errors: samples near zero count for the mean, and not for the maximum") {
    analysis::TorqueCurve ours;
    ours.angle = {0.0, 1.0, 2.0};
    ours.torque = {-10.0, -5.0, -2.0};
    ours.stage = {joint::Stage::linearity, joint::Stage::linearity, joint::Stage::transition};
    analysis::TorqueCurve measured;
    measured.angle = {0.0, 1.0, 2.0};
    measured.torque = {-10.0, -4.0, -0.02};
    const TorqueErrors errors = torque_errors(ours, measured, 0.0, 0.01, 0.5);
    CHECK(errors.stage[1].count == 1);
    CHECK(std::isnan(errors.stage[1].mre));
    CHECK(errors.stage[1].mape == doctest::Approx(99.0));
    CHECK(errors.all.mre == doctest::Approx(0.25));
    CHECK(errors.all.mape == doctest::Approx((0.25 + 99.0) / 3.0));
    CHECK(pool(errors, errors).all.mre == doctest::Approx(0.25));
    CHECK(std::isnan(pool(errors, errors).stage[1].mre));
}

TEST_CASE("Torque errors: pooling keeps the maximum and weights the mean") {
    TorqueErrors a, b;
    a.stage[1] = a.all = {1, 2, 0.4, 0.4};
    b.stage[1] = b.all = {3, 0, 0.2, 0.1};
    a.outside = 4;
    const TorqueErrors sum = pool(pool(TorqueErrors{}, a), b);
    CHECK(sum.stage[1].count == 4);
    CHECK(sum.stage[1].below == 2);
    CHECK(sum.stage[1].mre == doctest::Approx(0.4));
    CHECK(sum.stage[1].mape == doctest::Approx((0.4 + 3 * 0.1) / 4.0));
    CHECK(sum.outside == 4);
    CHECK(std::isnan(sum.stage[0].mape));
}
