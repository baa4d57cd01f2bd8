// How far our torque is from the measured one, stage by stage, as the paper of 2018 states it:
// relative error |T_v − T_a| / T_a, MRE its maximum and MAPE its mean.
#pragma once

#include <array>
#include <cstddef>

#include "game/analysis/torque_envelope.hpp"

namespace bolt::analysis {

struct StageError {
    std::size_t count = 0;  // samples judged
    std::size_t below = 0;  // left out: |T_a| below the floor, where a relative error says nothing
    double mre = 0.0;       // NaN where nothing was judged
    double mape = 0.0;
};

struct Errors {
    std::array<StageError, joint::stage_count> stage;
    StageError all;
    std::size_t outside = 0;  // left out: at angles our curve does not have
    double floor = 0.0;       // N·m; pooled: the largest
};

// Share of a run's highest |T_a| below which a sample is left out: 1 %, what a good torque sensor resolves.
inline constexpr double default_floor_share = 0.01;

// Our torque is taken between samples, our stage from the sample before. `shift` is added to the measured
// angles.
Errors errors_of(const analysis::Curve& ours, const analysis::Curve& measured, double shift, double floor);

// Maximum of the maxima, mean over all samples.
Errors pool(const Errors& a, const Errors& b);

// max |T| · default_floor_share
double floor_of(const analysis::Curve& measured, double share = default_floor_share);

}  // namespace bolt::analysis
