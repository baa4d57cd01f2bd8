#include "game/analysis/comparison.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/math.hpp"

using namespace bolt;
using namespace bolt::analysis;
using joint::Direction;
using joint::Stage;

TEST_CASE("Torque curve: strokes and re-grips give each angle once, with the torque that first reached it") {
    TorqueCurveBuilder builder(Direction::tighten);
    for (int stroke = 0; stroke < 4; ++stroke) {
        const double from = 0.1 * stroke;
        for (int i = 0; i <= 10; ++i)
            builder.add(from, 10.0 * from * i / 10.0, Stage::linearity);  // loading at rest
        builder.add(from, 99.0, Stage::linearity);                        // stuck nut
        for (int i = 1; i <= 10; ++i)
            builder.add(from + 0.01 * i, 10.0 * (from + 0.01 * i), Stage::linearity);
        builder.add(from + 0.1, 0.0, Stage::linearity);  // wrench off
    }
    const TorqueCurve curve = builder.finish();
    REQUIRE(curve.size() == 41);
    for (std::size_t i = 1; i < curve.size(); ++i) {
        CHECK(curve.angle[i] > curve.angle[i - 1]);
        CHECK(curve.torque[i] == doctest::Approx(10.0 * curve.angle[i]));
    }
    CHECK(curve.torque[0] == 99.0);  // the start angle has the breakaway torque
}

TEST_CASE("Torque curve: a loosening run starts at the largest angle") {
    TorqueCurveBuilder builder(Direction::loosen);
    for (int i = 0; i < 100; ++i) builder.add(0.01 * i, 1.0 * i, Stage::linearity);  // tightening first
    for (int i = 0; i <= 20; ++i) builder.add(0.99, -5.0 * i, Stage::linearity);     // loading backwards
    for (int i = 1; i <= 50; ++i) builder.add(0.99 - 0.01 * i, -80.0 + i, Stage::linearity);
    const TorqueCurve curve = builder.finish();
    REQUIRE(curve.size() == 51);
    CHECK(curve.torque[0] == doctest::Approx(-100.0));  // breakaway
    CHECK(curve.angle.back() == doctest::Approx(0.5));
    CHECK(curve.torque.back() == doctest::Approx(-30.0));
}

TEST_CASE("Torque curve: angles that a test rig counts up or down give the same curve") {
    const std::vector<double> up = {0.0, 0.1, 0.2, 0.3, 0.4}, down = {9.0, 8.9, 8.8, 8.7, 8.6};
    const std::vector<double> torque = {-0.1, -3.0, -1.0, -0.5, 0.0};
    for (const std::vector<double>& angle : {up, down}) {
        const TorqueCurve curve = make_torque_curve(angle, torque, Direction::loosen);
        REQUIRE(curve.size() == 5);
        CHECK(curve.angle[1] == doctest::Approx(0.1));
        CHECK(curve.torque[1] == -3.0);
        CHECK(curve.stage.empty());
    }
    CHECK(make_torque_curve({}, {}, Direction::tighten).empty());
}

TEST_CASE("Torque curve: a long curve is thinned and keeps its peak") {
    TorqueCurveBuilder builder(Direction::tighten);
    constexpr int count = 1 << 20;
    for (int i = 0; i < count; ++i) builder.add(1e-4 * i, i == 700001 ? 500.0 : 1.0, Stage::navigation);
    const TorqueCurve curve = builder.finish();
    CHECK(curve.size() <= std::size_t{1} << 18U);
    CHECK(curve.size() > std::size_t{1} << 16U);
    CHECK(*std::max_element(curve.torque.begin(), curve.torque.end()) == 500.0);
    CHECK(std::is_sorted(curve.angle.begin(), curve.angle.end()));
    CHECK(curve.angle.back() == doctest::Approx(1e-4 * count).epsilon(0.001));
}
