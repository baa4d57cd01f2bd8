// Descriptive statistics of a sample, and what a printed mean says about the sample behind it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "engine/base/function_ref.hpp"

namespace bolt::statistics {

// Quartiles of type 7 (Hyndman and Fan, Am. Stat. 50 (1996) 361), the default of NumPy and R: linear
// interpolation between the values.
struct Quartiles {
    double low = std::numeric_limits<double>::quiet_NaN(), median = low, high = low;
    std::size_t n = 0;
};

// Ignores values that are not finite. Without values all are NaN.
Quartiles quartiles(std::vector<double> values);

// Mean and sample standard deviation. Without values both are NaN, with one value the deviation.
struct MeanDeviation {
    std::size_t n = 0;
    double mean = std::numeric_limits<double>::quiet_NaN(), deviation = mean;
};
MeanDeviation mean_deviation(std::span<const double> values);

struct ConfidenceInterval {
    double low = std::numeric_limits<double>::quiet_NaN(), high = low;
};

struct BootstrapOptions {
    std::size_t resamples = 10000;
    double confidence = 0.95;
    std::uint64_t seed = 1;
};

// The percentile interval of a statistic (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, ch.
// 13): its quantiles over samples that are drawn from the values with replacement. NaN without values.
ConfidenceInterval bootstrap_interval(std::span<const double> values,
                                      FunctionRef<double(std::span<const double>)> statistic,
                                      const BootstrapOptions& options = {});

// The GRIM test (Brown and Heathers, Soc. Psychol. Personal. Sci. 8 (2017) 363): false if no `n` answers in
// steps of `step` from `low` have a mean that is printed as `mean` with so many decimals.
bool is_possible_mean(double mean, int decimals, std::size_t n, double step, double low = 0.0);

}  // namespace bolt::statistics
