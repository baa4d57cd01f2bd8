#include "game/plot/svg.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "engine/base/random.hpp"

using namespace bolt::plot;

namespace {

// 1, 2, 2.5 or 5 times a power of ten.
bool is_nice(double step) {
    const double decade = std::pow(10.0, std::floor(std::log10(step) + 1e-9));
    for (const double factor : {1.0, 2.0, 2.5, 5.0})
        if (std::abs(step - factor * decade) < 1e-6 * step) return true;
    return false;
}

}  // namespace

TEST_CASE("Axis ticks: covering ticks are round, evenly spaced and cover the range") {
    bolt::Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const double scale = std::pow(10.0, random.uniform(-6.0, 8.0));
        const double low = scale * random.uniform(-1.0, 1.0), high = low + scale * random.uniform(1e-3, 2.0);
        const int about = 2 + static_cast<int>(random.bits() % 8U);
        const AxisTicks ticks = covering_ticks(low, high, about);
        REQUIRE(ticks.values.size() >= 2);
        const double slack = 1e-6 * (high - low), step = ticks.values[1] - ticks.values[0];
        CHECK(ticks.values.front() <= low + slack);
        CHECK(ticks.values.back() >= high - slack);
        CHECK(ticks.range.low == doctest::Approx(ticks.values.front()));
        CHECK(ticks.range.high == doctest::Approx(ticks.values.back()));
        CHECK(is_nice(step));
        CHECK(ticks.values.size() <= static_cast<std::size_t>(about) + 2);
        // The labels of neighbours differ.
        CHECK(step * std::pow(10.0, ticks.decimals) > 0.99);
    }
}

TEST_CASE("Axis ticks: empty and invalid ranges still give an axis") {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const AxisTicks& ticks :
         {covering_ticks(0.0, 0.0), covering_ticks(nan, 1.0), covering_ticks(5.0, 5.0),
          covering_ticks(3.0, -3.0), covering_ticks(-HUGE_VAL, HUGE_VAL)}) {
        CHECK(ticks.values.size() >= 2);
        CHECK(ticks.range.span() > 0.0);
    }
}

TEST_CASE("Axis ticks: torques, degrees and counts have the expected ticks") {
    const AxisTicks torque = covering_ticks(0.0, 230.7, 5);
    CHECK(torque.values == std::vector<double>{0.0, 50.0, 100.0, 150.0, 200.0, 250.0});
    CHECK(torque.decimals == 0);
    CHECK(covering_ticks(0.0, 0.6, 3).decimals == 1);
    const AxisTicks degrees = degree_ticks({-33.0, 41.0}, 7);
    CHECK(degrees.values == std::vector<double>{-30.0, -15.0, 0.0, 15.0, 30.0});
    CHECK(degree_ticks({-100.0, 900.0}, 6).values ==
          std::vector<double>{0.0, 180.0, 360.0, 540.0, 720.0, 900.0});
    CHECK(count_ticks(1, 6).values == std::vector<double>{1, 2, 3, 4, 5, 6});
    CHECK(count_ticks(1, 100, 10).values.size() == 10);
}
