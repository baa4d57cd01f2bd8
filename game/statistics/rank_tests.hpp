// Rank tests with exact distributions for small samples, their effect sizes, and Holm's correction for
// several tests. Source of the tests: M. Hollander, D. A. Wolfe, E. Chicken, Nonparametric Statistical
// Methods, 2014.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "game/statistics/summary.hpp"

namespace bolt::statistics {

// Ranks from 1; equal values get the mean of their ranks (midranks).
std::vector<double> midranks(std::span<const double> values);

// An estimate of a location shift with its interval (Hodges and Lehmann 1963).
struct Shift {
    double estimate = std::numeric_limits<double>::quiet_NaN();
    // Each end is one of the values whose median is the estimate.
    ConfidenceInterval interval;
    // The confidence that the interval has, which may differ from the requested one. Exact without ties,
    // below 100 values.
    double confidence = 0.0;
};

// Wilcoxon's signed rank test of paired differences.
struct SignedRankTest {
    std::size_t n = 0;                      // number of differences that are not zero
    std::size_t zeros = 0;                  // differences that are zero; they are dropped
    double positive = 0.0, negative = 0.0;  // sums of the ranks of positive and of negative differences
    // Exact p-values, also with ties, over all 2^n assignments of signs to the midranks. The time grows with
    // n³.
    double p_greater = 1.0, p_less = 1.0, p_two_sided = 1.0;
    double rank_biserial = 0.0;  // (positive − negative) / (n (n + 1) / 2), −1 … 1
};
SignedRankTest signed_rank_test(std::span<const double> differences);

// The median of the averages of all pairs of differences, zeros dropped.
Shift paired_shift(std::span<const double> differences, double confidence = 0.95);

// The rank sum test of two independent samples (Wilcoxon, Mann and Whitney).
struct RankSumTest {
    std::size_t n_a = 0, n_b = 0;
    double u = 0.0;  // pairs in which the value of `a` is the larger one; a tie counts one half
    // p-values, below 100 values exact, also with ties, over all assignments of the midranks to the samples;
    // otherwise by the normal approximation with the correction for ties and for continuity.
    double p_greater = 1.0, p_less = 1.0, p_two_sided = 1.0;  // greater: `a` has the larger values
    double rank_biserial = 0.0;                               // 2 u / (n_a n_b) − 1, −1 … 1
};
RankSumTest rank_sum_test(std::span<const double> a, std::span<const double> b);

// The median of the differences a − b of all pairs.
Shift independent_shift(std::span<const double> a, std::span<const double> b, double confidence = 0.95);

// Friedman's test: compares conditions that every subject has been through.
struct FriedmanTest {
    std::size_t subjects = 0, conditions = 0;
    std::vector<double> rank_sums;  // by condition
    double chi_squared = 0.0;       // corrected for ties
    double p = 1.0;                 // of chi-squared with conditions − 1 degrees of freedom
    double kendall_w = 0.0;         // agreement of the subjects, 0 … 1
};
// `rows`: one for each subject, with one value for each condition. Rows must have the same length. With fewer
// than two rows or conditions, p is 1.
FriedmanTest friedman_test(std::span<const std::vector<double>> rows);

// Adjusts p-values of several tests (S. Holm, Scand. J. Statist. 6 (1979) 65), in the order given.
std::vector<double> holm(std::span<const double> p);

}  // namespace bolt::statistics
