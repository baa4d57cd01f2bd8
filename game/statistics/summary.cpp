#include "game/statistics/summary.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/random.hpp"

namespace bolt::statistics {

// The quantile of type 7 (Hyndman and Fan 1996).
static double quantile_of_sorted(std::span<const double> sorted, double share) {
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Quartiles quartiles(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {quantile_of_sorted(values, 0.25), quantile_of_sorted(values, 0.5),
            quantile_of_sorted(values, 0.75), values.size()};
}

MeanDeviation mean_deviation(std::span<const double> values) {
    MeanDeviation m;
    m.n = values.size();
    if (m.n == 0) return m;
    const auto n = static_cast<double>(m.n);
    m.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    if (m.n < 2) return m;
    double squares = 0.0;
    for (const double value : values) squares += (value - m.mean) * (value - m.mean);
    m.deviation = std::sqrt(squares / (n - 1.0));
    return m;
}

ConfidenceInterval bootstrap_interval(std::span<const double> values,
                                      FunctionRef<double(std::span<const double>)> statistic,
                                      const BootstrapOptions& options) {
    if (values.empty() || options.resamples == 0) return {};
    Random random(options.seed);
    std::vector<double> sample(values.size()), results(options.resamples);
    for (double& result : results) {
        for (double& value : sample) {
            const auto drawn =
                static_cast<std::size_t>(random.uniform() * static_cast<double>(values.size()));
            value = values[std::min(drawn, values.size() - 1)];
        }
        result = statistic(sample);
    }
    std::sort(results.begin(), results.end());
    const double tail = 0.5 * (1.0 - options.confidence);
    return {quantile_of_sorted(results, tail), quantile_of_sorted(results, 1.0 - tail)};
}

bool is_possible_mean(double mean, int decimals, std::size_t n, double step, double low) {
    if (n == 0 || !(step > 0.0)) return false;
    const double unit = std::pow(10.0, -decimals);
    const double sum = (mean - low) * static_cast<double>(n) / step;  // in steps
    for (const double whole : {std::floor(sum), std::ceil(sum)}) {
        const double possible = low + whole * step / static_cast<double>(n);
        // Half a unit either way: printed means are rounded up or to even.
        if (std::abs(possible - mean) <= 0.5 * unit * (1.0 + 1e-9)) return true;
    }
    return false;
}

}  // namespace bolt::statistics
