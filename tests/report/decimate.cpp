#include "game/plot/svg.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "game/analysis/joint_curve.hpp"

using namespace bolt::analysis;
using namespace bolt::plot;

namespace {

constexpr double gap = std::numeric_limits<double>::quiet_NaN();

std::vector<SvgPoint> noisy(std::uint64_t seed, std::size_t count) {
    bolt::Random random(seed);
    std::vector<SvgPoint> points;
    for (std::size_t i = 0; i < count; ++i)
        points.push_back(
            {0.01 * static_cast<double>(i), std::sin(0.002 * static_cast<double>(i)) + random.normal()});
    return points;
}

bool by_y(const SvgPoint& a, const SvgPoint& b) { return a.y < b.y; }

}  // namespace

TEST_CASE("Decimation: keeps the extremes of every column, the ends and the order") {
    const std::vector<SvgPoint> all = noisy(3, 20000);
    const std::vector<SvgPoint> few = decimate(all, 1.0);
    CHECK(few.size() <= 4 * 200);
    CHECK(few.front().x == all.front().x);
    CHECK(few.back().x == all.back().x);
    CHECK(std::is_sorted(few.begin(), few.end(),
                         [](const SvgPoint& a, const SvgPoint& b) { return a.x < b.x; }));
    for (int column = 0; column < 200; ++column) {
        const auto in_column = [&](const std::vector<SvgPoint>& points) {
            std::vector<SvgPoint> inside;
            for (const SvgPoint& p : points)
                if (std::floor(p.x) == column) inside.push_back(p);
            return inside;
        };
        const std::vector<SvgPoint> before = in_column(all), after = in_column(few);
        REQUIRE_FALSE(after.empty());
        CHECK(std::min_element(before.begin(), before.end(), by_y)->y ==
              std::min_element(after.begin(), after.end(), by_y)->y);
        CHECK(std::max_element(before.begin(), before.end(), by_y)->y ==
              std::max_element(after.begin(), after.end(), by_y)->y);
    }
}

TEST_CASE("Decimation: keeps gaps") {
    const std::vector<SvgPoint> points = {{0.1, 1.0}, {0.2, 5.0}, {gap, gap}, {0.3, 2.0}, {0.4, 0.0}};
    const std::vector<SvgPoint> few = decimate(points, 10.0);
    REQUIRE(few.size() == 5);
    CHECK(std::isnan(few[2].x));
}

TEST_CASE("Decimation: a clipped line keeps a neighbour on each side") {
    std::vector<SvgPoint> points;
    for (int i = 0; i < 10; ++i) points.push_back({double(i), double(i)});
    const std::vector<SvgPoint> inside = points_within(points, {2.5, 5.5});
    REQUIRE(inside.size() == 6);
    CHECK(inside[0].x == 2.0);
    CHECK(inside[3].x == 5.0);
    CHECK(inside[4].x == 6.0);
    CHECK(std::isnan(inside[5].x));
    CHECK(points_within(points, {20.0, 30.0}).empty());
}

TEST_CASE("Curve decimator: a stream of any length stays within its buckets and keeps its peaks") {
    for (const std::size_t count : {1U, 7U, 64U, 65U, 5000U, 100003U}) {
        bolt::Random random(count);
        CurveDecimator stream(64);
        CurvePoint low, high;
        low.torque = 1e9;
        high.torque = -1e9;
        for (std::size_t i = 0; i < count; ++i) {
            CurvePoint p;
            p.time = 0.001 * static_cast<double>(i);
            p.angle = 0.01 * static_cast<double>(i);
            p.torque = random.normal() + (i == count / 3 ? 50.0 : 0.0) - (i == count / 2 ? 70.0 : 0.0);
            if (p.torque < low.torque) low = p;
            if (p.torque > high.torque) high = p;
            stream.add(p);
        }
        const std::vector<CurvePoint> kept = stream.points();
        CHECK(kept.size() <= 4 * 64);
        CHECK(kept.front().time == 0.0);
        CHECK(kept.back().time == doctest::Approx(0.001 * static_cast<double>(count - 1)));
        CHECK(std::is_sorted(kept.begin(), kept.end(),
                             [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; }));
        const auto by_torque = [](const CurvePoint& a, const CurvePoint& b) { return a.torque < b.torque; };
        CHECK(std::min_element(kept.begin(), kept.end(), by_torque)->time == low.time);
        CHECK(std::max_element(kept.begin(), kept.end(), by_torque)->time == high.time);
    }
}

TEST_CASE("Curve decimator: constant samples take one point") {
    CurveDecimator stream(4);
    for (int i = 0; i < 1000; ++i) {
        CurvePoint p;
        p.time = i;
        p.torque = 3.0;
        stream.add(p);
    }
    CHECK(stream.points().size() == 1);
}
