#include "game/statistics/rank_tests.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

namespace bolt::statistics {

namespace {

// Number of values below which the distributions of rank sums and of shifts are exact. The time for a
// distribution of rank sums grows with its fourth power.
constexpr std::size_t max_exact = 100;

double median_of_sorted(std::span<const double> sorted) {
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

std::vector<double> without_zeros(std::span<const double> differences) {
    std::vector<double> kept(differences.begin(), differences.end());
    std::erase(kept, 0.0);
    return kept;
}

// Twice each midrank: whole numbers.
std::vector<std::size_t> doubled_ranks(std::span<const double> values) {
    std::vector<std::size_t> doubled;
    for (const double rank : midranks(values)) doubled.push_back(static_cast<std::size_t>(2.0 * rank + 0.5));
    return doubled;
}

// The probability of each sum of the doubled ranks that get a positive sign, each with probability 1/2.
std::vector<double> signed_sums(std::span<const std::size_t> doubled) {
    std::vector<double> p(1 + std::accumulate(doubled.begin(), doubled.end(), std::size_t{0}), 0.0);
    p[0] = 1.0;
    std::size_t reached = 0;
    for (const std::size_t rank : doubled) {
        for (std::size_t sum = reached + rank + 1; sum-- > 0;)
            p[sum] = 0.5 * (p[sum] + (sum >= rank ? p[sum - rank] : 0.0));
        reached += rank;
    }
    return p;
}

// The probability of each sum of `count` of the doubled ranks, drawn without replacement.
std::vector<double> drawn_sums(std::span<const std::size_t> doubled, std::size_t count) {
    const std::size_t total = std::accumulate(doubled.begin(), doubled.end(), std::size_t{0});
    // ways[k][s]: the number of ways to draw k of the ranks seen so far with the sum s.
    std::vector<std::vector<double>> ways(count + 1, std::vector<double>(total + 1, 0.0));
    ways[0][0] = 1.0;
    std::size_t seen = 0;
    for (const std::size_t rank : doubled) {
        ++seen;
        for (std::size_t k = std::min(seen, count); k > 0; --k)
            for (std::size_t sum = total + 1; sum-- > rank;) ways[k][sum] += ways[k - 1][sum - rank];
    }
    std::vector<double> p = ways[count];
    const double all = std::accumulate(p.begin(), p.end(), 0.0);
    for (double& value : p) value /= all;
    return p;
}

struct Tails {
    double less, greater, two_sided;  // P(X ≤ x), P(X ≥ x), and twice the smaller of both, at most 1
};

Tails tails(std::span<const double> p, std::size_t x) {
    const auto at = p.begin() + static_cast<std::ptrdiff_t>(x);
    const double less = std::min(1.0, std::accumulate(p.begin(), at + 1, 0.0));
    const double greater = std::min(1.0, std::accumulate(at, p.end(), 0.0));
    return {less, greater, std::min(1.0, 2.0 * std::min(less, greater))};
}

// The number of averages or differences that are positive if there is no shift, as a random variable.
struct PositiveCount {
    std::vector<double> p;   // of each number; empty for large samples: normal, with half of all as its mean
    double deviation = 0.0;  // of that normal distribution
};

// The largest k ≥ 1 with P(count ≤ k − 1) ≤ tail, and that probability.
std::pair<std::size_t, double> lowest_counts(const PositiveCount& count, std::size_t all, double tail) {
    if (count.p.empty()) {
        const double z = boost::math::quantile(boost::math::normal(), tail);
        const double k = std::floor(0.5 * static_cast<double>(all) + z * count.deviation + 0.5);
        return {static_cast<std::size_t>(std::max(1.0, k)), tail};
    }
    std::size_t k = 0;
    double below = 0.0;
    while (k < all && below + count.p[k] <= tail) below += count.p[k++];
    if (k == 0) below = count.p[k++];
    return {std::min(k, all), below};
}

// The interval between the k-th smallest and the k-th largest of the averages or differences.
Shift shift_of(std::vector<double> sorted, const PositiveCount& count, double confidence) {
    std::sort(sorted.begin(), sorted.end());
    const auto [k, below] = lowest_counts(count, sorted.size(), 0.5 * (1.0 - confidence));
    return {median_of_sorted(sorted),
            {sorted[k - 1], sorted[sorted.size() - k]},
            std::max(0.0, 1.0 - 2.0 * below)};
}

// Every second value from `first` on: only every second sum of doubled ranks occurs.
std::vector<double> every_second(std::span<const double> p, std::size_t first) {
    std::vector<double> counts;
    for (std::size_t i = first; i < p.size(); i += 2) counts.push_back(p[i]);
    return counts;
}

std::vector<std::size_t> ranks_without_ties(std::size_t n) {
    std::vector<std::size_t> doubled(n);
    for (std::size_t i = 0; i < n; ++i) doubled[i] = 2 * (i + 1);
    return doubled;
}

// The sum of t³ − t over groups of t equal values.
double tie_sum(std::span<const double> values) {
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    double sum = 0.0;
    for (auto begin = sorted.begin(); begin != sorted.end();) {
        const auto end = std::upper_bound(begin, sorted.end(), *begin);
        const auto t = static_cast<double>(end - begin);
        sum += t * t * t - t;
        begin = end;
    }
    return sum;
}

// The normal approximation of the rank sum test.
Tails approximate_tails(const RankSumTest& test, std::span<const double> all) {
    const auto a = static_cast<double>(test.n_a), b = static_cast<double>(test.n_b), n = a + b;
    const double variance = a * b / 12.0 * (n + 1.0 - tie_sum(all) / (n * (n - 1.0)));
    if (!(variance > 0.0)) return {1.0, 1.0, 1.0};
    const boost::math::normal normal;
    const double off = test.u - 0.5 * a * b, deviation = std::sqrt(variance);
    const double less = boost::math::cdf(normal, (off + 0.5) / deviation);
    const double greater = boost::math::cdf(boost::math::complement(normal, (off - 0.5) / deviation));
    return {less, greater, std::min(1.0, 2.0 * std::min(less, greater))};
}

}  // namespace

std::vector<double> midranks(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
    std::vector<double> ranks(values.size());
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
        for (std::size_t i = begin; i < end; ++i)
            ranks[order[i]] = 0.5 * static_cast<double>(begin + 1 + end);
        begin = end;
    }
    return ranks;
}

SignedRankTest signed_rank_test(std::span<const double> differences) {
    const std::vector<double> kept = without_zeros(differences);
    SignedRankTest test;
    test.n = kept.size();
    test.zeros = differences.size() - kept.size();
    if (kept.empty()) return test;
    std::vector<double> sizes;
    for (const double difference : kept) sizes.push_back(std::abs(difference));
    const std::vector<std::size_t> doubled = doubled_ranks(sizes);
    std::size_t positive = 0, all = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        all += doubled[i];
        if (kept[i] > 0.0) positive += doubled[i];
    }
    test.positive = 0.5 * static_cast<double>(positive);
    test.negative = 0.5 * static_cast<double>(all - positive);
    test.rank_biserial = (test.positive - test.negative) / (0.5 * static_cast<double>(all));
    const Tails p = tails(signed_sums(doubled), positive);
    test.p_less = p.less;
    test.p_greater = p.greater;
    test.p_two_sided = p.two_sided;
    return test;
}

Shift paired_shift(std::span<const double> differences, double confidence) {
    const std::vector<double> kept = without_zeros(differences);
    if (kept.empty()) return {};
    std::vector<double> averages;
    for (std::size_t i = 0; i < kept.size(); ++i)
        for (std::size_t j = i; j < kept.size(); ++j) averages.push_back(0.5 * (kept[i] + kept[j]));
    const auto n = static_cast<double>(kept.size());
    const PositiveCount count =
        kept.size() < max_exact
            ? PositiveCount{every_second(signed_sums(ranks_without_ties(kept.size())), 0), 0.0}
            : PositiveCount{{}, std::sqrt(n * (n + 1.0) * (2.0 * n + 1.0) / 24.0)};
    return shift_of(std::move(averages), count, confidence);
}

RankSumTest rank_sum_test(std::span<const double> a, std::span<const double> b) {
    RankSumTest test;
    test.n_a = a.size();
    test.n_b = b.size();
    if (a.empty() || b.empty()) return test;
    std::vector<double> all(a.begin(), a.end());
    all.insert(all.end(), b.begin(), b.end());
    const std::vector<std::size_t> doubled = doubled_ranks(all);
    const auto end_of_a = doubled.begin() + static_cast<std::ptrdiff_t>(a.size());
    const std::size_t sum = std::accumulate(doubled.begin(), end_of_a, std::size_t{0});
    const auto n_a = static_cast<double>(a.size()), n_b = static_cast<double>(b.size());
    test.u = 0.5 * static_cast<double>(sum) - 0.5 * n_a * (n_a + 1.0);
    test.rank_biserial = 2.0 * test.u / (n_a * n_b) - 1.0;
    const Tails p =
        all.size() < max_exact ? tails(drawn_sums(doubled, a.size()), sum) : approximate_tails(test, all);
    test.p_less = p.less;
    test.p_greater = p.greater;
    test.p_two_sided = p.two_sided;
    return test;
}

Shift independent_shift(std::span<const double> a, std::span<const double> b, double confidence) {
    if (a.empty() || b.empty()) return {};
    std::vector<double> differences;
    for (const double x : a)
        for (const double y : b) differences.push_back(x - y);
    const std::size_t n = a.size() + b.size();
    const auto pairs = static_cast<double>(differences.size());
    // The smallest doubled sum of the ranks of `a` is a.size() (a.size() + 1).
    const PositiveCount count =
        n < max_exact ? PositiveCount{every_second(drawn_sums(ranks_without_ties(n), a.size()),
                                                   a.size() * (a.size() + 1)),
                                      0.0}
                      : PositiveCount{{}, std::sqrt(pairs * (static_cast<double>(n) + 1.0) / 12.0)};
    return shift_of(std::move(differences), count, confidence);
}

FriedmanTest friedman_test(std::span<const std::vector<double>> rows) {
    FriedmanTest test;
    test.subjects = rows.size();
    test.conditions = rows.empty() ? 0 : rows.front().size();
    test.rank_sums.assign(test.conditions, 0.0);
    double ties = 0.0;
    for (const std::vector<double>& row : rows) {
        const std::vector<double> ranks = midranks(row);
        for (std::size_t j = 0; j < test.conditions; ++j) test.rank_sums[j] += ranks[j];
        ties += tie_sum(row);
    }
    if (test.subjects < 2 || test.conditions < 2) return test;
    const auto n = static_cast<double>(test.subjects), k = static_cast<double>(test.conditions);
    double squares = 0.0;
    for (const double sum : test.rank_sums) {
        const double off = sum - 0.5 * n * (k + 1.0);
        squares += off * off;
    }
    const double scale = n * k * (k + 1.0) - ties / (k - 1.0);
    if (!(scale > 0.0)) return test;  // all values of each row are equal
    test.chi_squared = 12.0 * squares / scale;
    test.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(k - 1.0), test.chi_squared));
    test.kendall_w = test.chi_squared / (n * (k - 1.0));
    return test;
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
    std::vector<double> adjusted(p.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        largest = std::max(largest, std::min(1.0, p[order[i]] * static_cast<double>(p.size() - i)));
        adjusted[order[i]] = largest;
    }
    return adjusted;
}

}  // namespace bolt::statistics
