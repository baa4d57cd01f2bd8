// Where a measured curve lies on ours: a rig counts its angle from anywhere.
#pragma once

#include "engine/base/result.hpp"
#include "game/analysis/torque_envelope.hpp"

namespace bolt::analysis {

// Tightening curves are laid upon each other where the torque first passes this share of the end torque that
// both reach: half-way up the elastic line, where the angle is sharpest.
inline constexpr double default_share = 0.5;

struct Alignment {
    double shift = 0.0;      // rad, to be added to the measured angle
    double our_angle = 0.0;  // rad, of the common point
    double measured_angle = 0.0;
    double torque = 0.0;  // N·m, of the common point on the measured curve
};

// Both curves as analysis::advance_curve makes them (each angle once). Tightening: by the running maximum of
// the torque, so that a re-grip or a ripple cannot be taken for the passing; loosening: by the breakaway
// peak.
Result<Alignment> align(const analysis::Curve& ours, const analysis::Curve& measured,
                        double share = default_share);

}  // namespace bolt::analysis
