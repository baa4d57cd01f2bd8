// Oracles: printed results of R and SciPy, closed forms, and enumeration of all assignments.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "engine/base/random.hpp"
#include "game/statistics/rank_tests.hpp"

using namespace bolt;
using namespace bolt::statistics;

namespace {

constexpr auto mean_of = [](std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
};

// Differences 1 … n whose positive ranks have the sum `positive`.
std::vector<double> differences_with(std::size_t n, std::size_t positive) {
    std::vector<double> differences(n);
    for (std::size_t rank = n; rank > 0; --rank) {
        const bool plus = rank <= positive;
        if (plus) positive -= rank;
        differences[rank - 1] = (plus ? 1.0 : -1.0) * static_cast<double>(rank);
    }
    REQUIRE(positive == 0);
    return differences;
}

// Values with many ties.
std::vector<double> coarse(Random& random, std::size_t n) {
    std::vector<double> values(n);
    for (double& value : values) value = std::floor(random.uniform(-3.0, 4.0));
    return values;
}

}  // namespace

TEST_CASE("Quartiles: type 7, without values that are not finite") {
    std::vector<double> values(10);
    std::iota(values.begin(), values.end(), 1.0);
    const Quartiles q = quartiles(values);
    CHECK(q.low == 3.25);
    CHECK(q.median == 5.5);
    CHECK(q.high == 7.75);
    CHECK(q.n == 10);
    const Quartiles some = quartiles({7.0, 1.0, 3.0, std::nan(""), 10.0, 4.0, 20.0});
    CHECK(some.n == 6);
    CHECK(some.low == doctest::Approx(3.25));
    CHECK(some.median == doctest::Approx(5.5));
    CHECK(some.high == doctest::Approx(9.25));
    CHECK(quartiles({2.0}).high == 2.0);
    CHECK_FALSE(std::isfinite(quartiles({}).median));
}

TEST_CASE("Signed rank test: Darwin's maize, as SciPy prints it") {
    const std::array<double, 15> differences{6, 8, 14, 16, 23, 24, 28, 29, 41, -48, 49, 56, 60, -67, 75};
    const SignedRankTest test = signed_rank_test(differences);
    CHECK(test.n == 15);
    CHECK(test.negative == 24.0);
    CHECK(test.p_two_sided == 0.041259765625);
    CHECK(test.p_greater == 0.0206298828125);
    CHECK(test.rank_biserial == doctest::Approx(0.6).epsilon(1e-14));
    const Shift shift = paired_shift(differences);
    CHECK(shift.estimate == 25.0);
    CHECK(shift.interval.low == 4.0);
    CHECK(shift.interval.high == 41.5);
    CHECK(shift.confidence >= 0.95);
    CHECK(shift.confidence < 0.96);
}

TEST_CASE("Signed rank test: the depression scales of R's wilcox.test") {
    const std::array<double, 9> before{1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30},
        after{0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
    std::vector<double> differences;
    for (std::size_t i = 0; i < before.size(); ++i) differences.push_back(before[i] - after[i]);
    const SignedRankTest test = signed_rank_test(differences);
    CHECK(test.positive == 40.0);
    CHECK(test.p_greater == 10.0 / 512.0);
    CHECK(test.p_two_sided == 0.0390625);
}

TEST_CASE("Signed rank test: the limits of the two-sided 5 % level for 6 to 20 differences") {
    const std::array<std::size_t, 15> limits{0, 2, 3, 5, 8, 10, 13, 17, 21, 25, 29, 34, 40, 46, 52};
    for (std::size_t n = 6; n <= 20; ++n) {
        CAPTURE(n);
        CHECK(signed_rank_test(differences_with(n, limits[n - 6])).p_two_sided <= 0.05);
        CHECK(signed_rank_test(differences_with(n, limits[n - 6] + 1)).p_two_sided > 0.05);
    }
    // With five nothing is significant.
    CHECK(signed_rank_test(differences_with(5, 0)).p_two_sided == 0.0625);
}

TEST_CASE("Signed rank test: with ties and zeros, all assignments of signs are counted") {
    Random random(7);
    for (int i = 0; i < 50; ++i) {
        const std::vector<double> differences = coarse(random, 3 + static_cast<std::size_t>(i) % 8);
        const SignedRankTest test = signed_rank_test(differences);
        std::vector<double> sizes;
        for (const double difference : differences)
            if (difference != 0.0) sizes.push_back(std::abs(difference));
        CHECK(test.n == sizes.size());
        CHECK(test.zeros == differences.size() - sizes.size());
        const std::vector<double> ranks = midranks(sizes);
        int less = 0, greater = 0;
        const int all = 1 << sizes.size();
        for (int signs = 0; signs < all; ++signs) {
            double sum = 0.0;
            for (std::size_t k = 0; k < ranks.size(); ++k) sum += (signs >> k & 1) != 0 ? ranks[k] : 0.0;
            less += sum <= test.positive ? 1 : 0;
            greater += sum >= test.positive ? 1 : 0;
        }
        CHECK(test.p_less == doctest::Approx(double(less) / all).epsilon(1e-12));
        CHECK(test.p_greater == doctest::Approx(double(greater) / all).epsilon(1e-12));
    }
    CHECK(signed_rank_test(std::array<double, 3>{0.0, 0.0, 0.0}).p_two_sided == 1.0);
}

TEST_CASE("Rank sum test: R's example of permeability, and its mirror") {
    const std::array<double, 10> a{0.80, 0.83, 1.89, 1.04, 1.45, 1.38, 1.91, 1.64, 0.73, 1.46};
    const std::array<double, 5> b{1.15, 0.88, 0.90, 0.74, 1.21};
    const RankSumTest test = rank_sum_test(a, b);
    CHECK(test.u == 35.0);
    CHECK(test.p_greater == doctest::Approx(0.1272).epsilon(0.0005));
    const RankSumTest mirror = rank_sum_test(b, a);
    CHECK(mirror.u == 15.0);
    CHECK(mirror.p_less == doctest::Approx(test.p_greater).epsilon(1e-12));
    CHECK(mirror.rank_biserial == doctest::Approx(-test.rank_biserial).epsilon(1e-12));
    const Shift shift = independent_shift(a, b), back = independent_shift(b, a);
    CHECK(shift.estimate == doctest::Approx(-back.estimate).epsilon(1e-12));
    CHECK(shift.interval.low == doctest::Approx(-back.interval.high).epsilon(1e-12));
    CHECK(shift.interval.low < shift.estimate);
    CHECK(shift.estimate < shift.interval.high);
    CHECK(shift.confidence >= 0.95);
}

TEST_CASE("Rank sum test: with ties, all assignments to the samples are counted") {
    Random random(11);
    for (int i = 0; i < 40; ++i) {
        const std::vector<double> all = coarse(random, 5 + static_cast<std::size_t>(i) % 6);
        const std::size_t n_a = 2 + static_cast<std::size_t>(i) % 3;
        const RankSumTest test = rank_sum_test(std::span(all).first(n_a), std::span(all).subspan(n_a));
        const std::vector<double> ranks = midranks(all);
        double pairs = 0.0;
        for (std::size_t x = 0; x < n_a; ++x)
            for (std::size_t y = n_a; y < all.size(); ++y)
                pairs += all[x] > all[y] ? 1.0 : all[x] == all[y] ? 0.5 : 0.0;
        CHECK(test.u == doctest::Approx(pairs));
        const double observed = std::accumulate(ranks.begin(), ranks.begin() + std::ptrdiff_t(n_a), 0.0);
        int count = 0, less = 0, greater = 0;
        for (int chosen = 0; chosen < 1 << all.size(); ++chosen) {
            double sum = 0.0;
            std::size_t size = 0;
            for (std::size_t k = 0; k < all.size(); ++k) {
                if ((chosen >> k & 1) == 0) continue;
                ++size;
                sum += ranks[k];
            }
            if (size != n_a) continue;
            ++count;
            less += sum <= observed ? 1 : 0;
            greater += sum >= observed ? 1 : 0;
        }
        CHECK(test.p_less == doctest::Approx(double(less) / count).epsilon(1e-12));
        CHECK(test.p_greater == doctest::Approx(double(greater) / count).epsilon(1e-12));
    }
}

TEST_CASE("Rank sum test: the normal approximation of large samples continues the exact distribution") {
    Random random(3);
    std::vector<double> a(49), b(50);
    for (double& value : a) value = random.normal() + 0.4;
    for (double& value : b) value = random.normal();
    const RankSumTest exact = rank_sum_test(a, b);
    a.push_back(100.0);  // one more, so that the approximation is used
    const RankSumTest approximate = rank_sum_test(a, b);
    CHECK(exact.p_two_sided == doctest::Approx(approximate.p_two_sided).epsilon(0.5));
    // The same values twice as often as in a small sample with ties.
    const std::vector<double> equal(60, 1.0);
    CHECK(rank_sum_test(equal, equal).p_two_sided == 1.0);
}

TEST_CASE("Shift: the normal approximation of large samples continues the exact intervals") {
    const auto spaced = [](std::size_t n) {
        std::vector<double> values(n);
        for (std::size_t i = 0; i < n; ++i) values[i] = (double(i) + 0.5) / double(n);
        return values;
    };
    const Shift exact = independent_shift(spaced(49), spaced(50)),
                approximate = independent_shift(spaced(50), spaced(50));
    CHECK(approximate.interval.low == doctest::Approx(exact.interval.low).epsilon(0.02));
    CHECK(approximate.interval.high == doctest::Approx(exact.interval.high).epsilon(0.02));
    CHECK(exact.confidence != 0.95);
    CHECK(approximate.confidence == doctest::Approx(0.95));
    const Shift paired = paired_shift(spaced(99)), large = paired_shift(spaced(100));
    CHECK(large.interval.low == doctest::Approx(paired.interval.low).epsilon(0.01));
    CHECK(large.interval.high == doctest::Approx(paired.interval.high).epsilon(0.01));
    // 4 · 10⁶ pairs; the exact distribution would take hours.
    CHECK(independent_shift(spaced(2000), spaced(2000)).interval.high < 0.03);
}

TEST_CASE("Shift: the interval covers the true shift as often as it states") {
    Random random(1);
    int covered = 0;
    constexpr int repeats = 3000;
    for (int i = 0; i < repeats; ++i) {
        std::vector<double> a(8), b(7);
        for (double& value : a) value = random.uniform() + 0.3;
        for (double& value : b) value = random.uniform();
        const Shift shift = independent_shift(a, b);
        covered += shift.interval.low <= 0.3 && 0.3 <= shift.interval.high ? 1 : 0;
    }
    const double stated = independent_shift(std::vector<double>(8), std::vector<double>(7)).confidence;
    CHECK(stated >= 0.95);
    // Three standard deviations of the share.
    CHECK(std::abs(double(covered) / repeats - stated) < 3.0 * std::sqrt(stated * (1.0 - stated) / repeats));
}

TEST_CASE("Friedman test: the rounding times of R's friedman.test") {
    const std::vector<std::vector<double>> rows{
        {5.40, 5.50, 5.55}, {5.85, 5.70, 5.75}, {5.20, 5.60, 5.50}, {5.55, 5.50, 5.40}, {5.90, 5.85, 5.70},
        {5.45, 5.55, 5.60}, {5.40, 5.40, 5.35}, {5.45, 5.50, 5.35}, {5.25, 5.15, 5.00}, {5.85, 5.80, 5.70},
        {5.25, 5.20, 5.10}, {5.65, 5.55, 5.45}, {5.60, 5.35, 5.45}, {5.05, 5.00, 4.95}, {5.50, 5.50, 5.40},
        {5.45, 5.55, 5.50}, {5.55, 5.55, 5.35}, {5.45, 5.50, 5.55}, {5.50, 5.45, 5.25}, {5.65, 5.60, 5.40},
        {5.70, 5.65, 5.55}, {6.30, 6.30, 6.25}};
    const FriedmanTest test = friedman_test(rows);
    CHECK(test.subjects == 22);
    CHECK(test.rank_sums == std::vector<double>{53.0, 47.0, 32.0});
    CHECK(test.chi_squared == doctest::Approx(11.142857).epsilon(1e-7));
    CHECK(test.p == doctest::Approx(0.003805).epsilon(1e-4));
    CHECK(test.kendall_w == doctest::Approx(0.2532).epsilon(2e-4));
    CHECK(friedman_test(std::vector<std::vector<double>>{{1.0, 1.0}, {2.0, 2.0}}).p == 1.0);
    CHECK(friedman_test({}).p == 1.0);
}

TEST_CASE("Holm: the adjusted values of a textbook example, in the order given") {
    const std::vector<double> adjusted = holm(std::array<double, 4>{0.01, 0.04, 0.03, 0.005});
    const std::array<double, 4> expected{0.03, 0.06, 0.06, 0.02};
    for (std::size_t i = 0; i < expected.size(); ++i)
        CHECK(adjusted[i] == doctest::Approx(expected[i]).epsilon(1e-12));
    CHECK(holm(std::array<double, 2>{0.9, 0.8})[0] == 1.0);
}

TEST_CASE("Bootstrap: the same seed gives the same interval, which covers a mean as often as is known") {
    Random random(9);
    int covered = 0;
    constexpr int repeats = 300;
    for (int i = 0; i < repeats; ++i) {
        std::vector<double> values(20);
        for (double& value : values) value = random.normal();
        const ConfidenceInterval interval = bootstrap_interval(values, mean_of, {400, 0.95, 1});
        const ConfidenceInterval again = bootstrap_interval(values, mean_of, {400, 0.95, 1});
        CHECK(interval.low == again.low);
        CHECK(interval.high == again.high);
        CHECK(bootstrap_interval(values, mean_of, {400, 0.95, 2}).low != interval.low);
        covered += interval.low <= 0.0 && 0.0 <= interval.high ? 1 : 0;
    }
    // Percentile intervals of small samples are too narrow: about 92 % for 20 normal values.
    CHECK(covered > 0.87 * repeats);
    CHECK(covered < 0.97 * repeats);
    CHECK(std::isnan(bootstrap_interval({}, mean_of).low));
}

TEST_CASE("GRIM: none of the paper's means comes from 20 scores, two of them come from 19") {
    for (const double mean : {8.103, 8.263, 6.684, 7.514})
        for (const double step : {1.0, 0.5, 0.2, 0.1}) {
            CAPTURE(mean);
            CAPTURE(step);
            CHECK_FALSE(is_possible_mean(mean, 3, 20, step));
        }
    CHECK(is_possible_mean(8.263, 3, 19, 1.0));      // 157/19
    CHECK(is_possible_mean(1.667, 3, 3, 2.0, 1.0));  // 1, 1 and 3
    CHECK_FALSE(is_possible_mean(1.667, 3, 3, 2.0));
    CHECK(is_possible_mean(6.684, 3, 19, 1.0));  // 127/19
    CHECK_FALSE(is_possible_mean(8.103, 3, 19, 1.0));
    CHECK_FALSE(is_possible_mean(7.514, 3, 19, 1.0));
    Random random(4);
    for (int i = 0; i < 500; ++i) {
        const std::size_t n = 1 + std::size_t(random.uniform(0.0, 40.0));
        const double whole = std::floor(random.uniform(0.0, 10.0 * double(n)));
        const double mean = std::round(1000.0 * whole / double(n)) / 1000.0;
        CHECK(is_possible_mean(mean, 3, n, 1.0));
    }
}
