// Confidence bands over the repetitions of a measured run. A repetition is the unit that varies from bolt to
// bolt, so whole repetitions are resampled, never single samples of a curve, which depend on each other.
//
// All intervals are percentile bootstrap intervals of 95 % (statistics/summary.hpp) with the fixed seed
// `band_seed`, so equal files give equal pages. Below `min_repetitions` they are not computed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "game/analysis/comparison.hpp"
#include "game/statistics/summary.hpp"

namespace bolt::analysis {

inline constexpr std::size_t min_repetitions = 4;
inline constexpr std::uint64_t band_seed = 1;

// Intervals of the errors of a stage or of all, each error pooled over the samples of all repetitions.
struct StageBand {
    statistics::ConfidenceInterval mape, rmse;  // NaN: not enough repetitions with samples
};

struct RepetitionBands {
    std::size_t repetitions = 0;
    std::array<StageBand, joint::stage_count> stage;
    StageBand all;
    // Means over the repetitions that have the value, and their intervals; NaN without one.
    double slope_error = nan, breakaway_error = nan;
    statistics::ConfidenceInterval slope_interval, breakaway_interval;
};

// Each cycle is one repetition.
RepetitionBands repetition_bands(std::span<const CycleComparison> cycles);

// The mean measured torque with its interval, at evenly spaced angles that all repetitions reach, counted as
// in the simulated curve.
struct CurveBand {
    std::vector<double> angle;            // rad, ascending; empty: not enough repetitions
    std::vector<double> mean, low, high;  // N·m
};

CurveBand curve_band(std::span<const MeasuredCurve> measured, std::span<const CycleComparison> cycles);

}  // namespace bolt::analysis
