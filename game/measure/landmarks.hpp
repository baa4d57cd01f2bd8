// Landmarks of a measured torque–angle curve: run-down, seat, linear part and yield of a tightening run;
// breakaway and run-off of a loosening run.
//
// Definitions, for a curve without model knowledge:
//   gradient   slope of the regression line over a window of the angle
//   linear     the angles around the steepest gradient where the gradient is at least 0.75 of the slope of
//              their regression line; the mechanistic law separates transition and linearity at this share
//   seat       where the line of the linear part meets the mean torque of the run-down (projected tangent,
//              as in torque–angle signature analysis)
//   yield      from where the gradient stays below half of the slope of the linear part, as controllers of
//              yield-controlled tightening decide
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "game/analysis/comparison.hpp"

namespace bolt::measure {

struct Landmark {
    double angle = 0.0;   // rad, as in the curve
    double torque = 0.0;  // N·m
};

// Torque while the nut turns without load.
struct FreeTurning {
    double mean = 0.0, deviation = 0.0;  // N·m; standard deviation of the samples
    double begin = 0.0, end = 0.0;       // rad
    std::size_t samples = 0;
};

struct LinearPart {
    double begin = 0.0, end = 0.0;  // rad
    double slope = 0.0;             // N·m/rad
    double slope_error = 0.0;       // standard error of the regression, N·m/rad
    double torque = 0.0;            // N·m, of the line at `begin`
    std::size_t samples = 0;

    [[nodiscard]] double at(double angle) const { return torque + slope * (angle - begin); }
};

struct Landmarks {
    Landmark peak;                     // highest torque; loosening: breakaway (lowest torque)
    Landmark last;                     // end of the curve
    std::optional<FreeTurning> free;   // run-down before the seat; loosening: after the clamp force is gone
    std::optional<LinearPart> linear;  // tightening only, as the next two
    std::optional<double> seat;        // rad; assumes no free torque if the run-down was not recorded
    std::optional<Landmark> yield;     // where it begins
    std::optional<double> released;    // loosening: rad at which the torque has fallen to 5 % of the peak
    std::string missing;               // why there is no linear part; may be empty
};

// The fewest samples of a linear part.
inline constexpr std::size_t min_linear_samples = 4;

// `curve`: from analysis::make_torque_curve().
Landmarks find_landmarks(const analysis::TorqueCurve& curve);

}  // namespace bolt::measure
