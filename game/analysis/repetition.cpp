#include "game/analysis/repetition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::analysis {

namespace {

constexpr std::size_t band_points = 121;
constexpr statistics::BootstrapOptions band_options{.resamples = 2000, .confidence = 0.95, .seed = band_seed};

// Pools the errors of a stage over repetitions. A bootstrap sample consists of indices of repetitions.
template <class Pick>
StageBand stage_band(std::span<const CycleComparison> cycles, const Pick& pick) {
    std::vector<double> indices;
    for (std::size_t i = 0; i < cycles.size(); ++i)
        if (const StageError& e = pick(cycles[i]); e.count + e.below > 0)
            indices.push_back(static_cast<double>(i));
    StageBand band;
    if (indices.size() < min_repetitions) return band;
    const auto pooled_mape = [&](std::span<const double> sample) {
        double sum = 0.0, count = 0.0;
        for (const double index : sample) {
            const StageError& e = pick(cycles[static_cast<std::size_t>(index)]);
            if (e.count == 0) continue;
            sum += e.mape * static_cast<double>(e.count);
            count += static_cast<double>(e.count);
        }
        return count > 0.0 ? sum / count : 0.0;
    };
    const auto pooled_rmse = [&](std::span<const double> sample) {
        double sum = 0.0, count = 0.0;
        for (const double index : sample) {
            const StageError& e = pick(cycles[static_cast<std::size_t>(index)]);
            const auto n = static_cast<double>(e.count + e.below);
            sum += e.rmse * e.rmse * n;
            count += n;
        }
        return std::sqrt(sum / count);
    };
    const auto with_relative = std::count_if(indices.begin(), indices.end(), [&](double index) {
        return pick(cycles[static_cast<std::size_t>(index)]).count > 0;
    });
    if (static_cast<std::size_t>(with_relative) >= min_repetitions)
        band.mape = statistics::bootstrap_interval(indices, pooled_mape, band_options);
    band.rmse = statistics::bootstrap_interval(indices, pooled_rmse, band_options);
    return band;
}

statistics::ConfidenceInterval mean_interval(const std::vector<double>& values) {
    if (values.size() < min_repetitions) return {};
    return statistics::bootstrap_interval(
        values, [](std::span<const double> v) { return statistics::mean_deviation(v).mean; }, band_options);
}

}  // namespace

RepetitionBands repetition_bands(std::span<const CycleComparison> cycles) {
    RepetitionBands bands;
    bands.repetitions = cycles.size();
    for (std::size_t i = 0; i < bands.stage.size(); ++i)
        bands.stage[i] = stage_band(
            cycles, [i](const CycleComparison& c) -> const StageError& { return c.errors.stage[i]; });
    bands.all =
        stage_band(cycles, [](const CycleComparison& c) -> const StageError& { return c.errors.all; });
    std::vector<double> slopes, breakaways;
    for (const CycleComparison& cycle : cycles) {
        if (std::isfinite(cycle.slope_error)) slopes.push_back(cycle.slope_error);
        if (std::isfinite(cycle.breakaway_error)) breakaways.push_back(cycle.breakaway_error);
    }
    bands.slope_error = statistics::mean_deviation(slopes).mean;
    bands.breakaway_error = statistics::mean_deviation(breakaways).mean;
    bands.slope_interval = mean_interval(slopes);
    bands.breakaway_interval = mean_interval(breakaways);
    return bands;
}

CurveBand curve_band(std::span<const MeasuredCurve> measured, std::span<const CycleComparison> cycles) {
    CurveBand band;
    const std::size_t count = std::min(measured.size(), cycles.size());
    if (count < min_repetitions) return band;
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        if (measured[i].curve.size() < 2) return band;
        low = std::max(low, measured[i].curve.angle.front() + cycles[i].alignment.shift);
        high = std::min(high, measured[i].curve.angle.back() + cycles[i].alignment.shift);
    }
    if (!(high > low)) return band;
    std::vector<double> torques(count);
    for (std::size_t k = 0; k < band_points; ++k) {
        const double angle =
            low + (high - low) * static_cast<double>(k) / static_cast<double>(band_points - 1);
        for (std::size_t i = 0; i < count; ++i)
            torques[i] = interpolate(measured[i].curve.angle, measured[i].curve.torque,
                                     angle - cycles[i].alignment.shift);
        const statistics::ConfidenceInterval interval = mean_interval(torques);
        band.angle.push_back(angle);
        band.mean.push_back(statistics::mean_deviation(torques).mean);
        band.low.push_back(interval.low);
        band.high.push_back(interval.high);
    }
    return band;
}

}  // namespace bolt::analysis
