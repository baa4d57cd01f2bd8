#include "haptics/servo/servo_thread.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::servo;

TEST_CASE("Histogram: bins cover all values without a gap, none wider than a sixteenth") {
    std::uint64_t begin = 0;
    for (std::size_t bin = 0; bin < Histogram::bins; ++bin) {
        const std::uint64_t end = end_of(bin);
        REQUIRE(end > begin);
        REQUIRE(bin_of(begin) == bin);
        REQUIRE(bin_of(end - 1) == bin);
        REQUIRE((end - begin == 1 || 16 * (end - begin) <= begin));
        begin = end;
    }
    CHECK(begin == Histogram::max_duration + 1);
}

TEST_CASE("Histogram: quantiles never underestimate and overestimate by at most a sixteenth") {
    Random random(3);
    for (int trial = 0; trial < 20; ++trial) {
        Histogram h;
        std::vector<std::int64_t> values;
        const int n = 1 + static_cast<int>(random.uniform(0.0, 3000.0));
        for (int i = 0; i < n; ++i) {
            values.push_back(static_cast<std::int64_t>(std::pow(10.0, random.uniform(0.0, 9.5))));
            add(h, values.back());
        }
        std::sort(values.begin(), values.end());
        for (const double share : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
            const auto rank = static_cast<std::size_t>(std::ceil(share * n)) - 1;
            const double truth = 1e-9 * static_cast<double>(values[rank]);
            CHECK(quantile(h, share) >= truth * (1 - 1e-12));
            CHECK(quantile(h, share) <= truth * (17.0 / 16.0));
        }
        CHECK(h.min == static_cast<std::uint64_t>(values.front()));
        CHECK(quantile(h, 1.0) == doctest::Approx(1e-9 * static_cast<double>(values.back())).epsilon(1e-12));
    }
}

TEST_CASE("Histogram: empty gives zeros; negative and endless durations are counted") {
    Histogram h;
    CHECK(quantile(h, 0.5) == 0.0);
    CHECK(mean(h) == 0.0);
    CHECK(share_above(h, 0.0) == 0.0);
    add(h, -5);
    add(h, std::int64_t{1} << 62);
    CHECK(h.count == 2);
    CHECK(h.min == 0);
    CHECK(h.max == Histogram::max_duration);
    CHECK(h.counts[0] == 1);
    CHECK(h.counts[Histogram::bins - 1] == 1);
}

TEST_CASE("Histogram: mean, share above and sums of histograms are exact") {
    Histogram a, b, all;
    for (int us = 1; us <= 1000; ++us) {
        add(us % 3 == 0 ? a : b, 1000 * us);
        add(all, 1000 * us);
    }
    CHECK(mean(all) == doctest::Approx(500.5e-6));
    CHECK(share_above(all, 750e-6) == doctest::Approx(0.25).epsilon(0.1));
    CHECK(share_above(all, 2e-3) == 0.0);
    CHECK(share_above(all, 0.0) == 1.0);
    add(a, b);
    CHECK(a.counts == all.counts);
    CHECK(a.min == all.min);
    CHECK(a.max == all.max);
    CHECK(mean(a) == doctest::Approx(mean(all)));
}
