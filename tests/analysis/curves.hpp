// Closed-form curves for the tests of the comparison.
#pragma once

#include <cmath>
#include <functional>

#include "engine/base/math.hpp"
#include "game/analysis/comparison.hpp"

namespace bolt::analysis {

// Flat, then an elastic line of 3 N·m per degree from 60° on, with a smooth transition.
inline double tightening_torque(double degrees) {
    return 0.5 + 3.0 * 4.0 * std::log1p(std::exp((degrees - 60.0) / 4.0));
}

// Breaks loose at once, then the torque decreases.
inline double loosening_torque(double degrees) { return -0.02 - 5.0 * std::exp(-degrees / 9.0); }

inline joint::Stage stage_at(double torque) {
    const double t = std::abs(torque);
    if (t < 1.0) return joint::Stage::navigation;
    if (t < 10.0) return joint::Stage::transition;
    return t < 80.0 ? joint::Stage::linearity : joint::Stage::yield;
}

inline analysis::TorqueCurve curve_of(const std::function<double(double)>& torque, double from, double to,
                                      double step, joint::Direction direction) {
    analysis::TorqueCurve curve;
    curve.direction = direction;
    for (double at = from; at <= to; at += step) {
        curve.angle.push_back(to_radians(at - from));
        curve.torque.push_back(torque(at));
        curve.stage.push_back(stage_at(torque(at)));
    }
    return curve;
}

}  // namespace bolt::analysis
