// Fits friction, compliance and the yield load of a joint design to measured tightening or loosening runs, as
// far as torque and angle determine them. Clamp force is not measured, so most quantities appear as products
// only; the result says which assumption separates them.
//
// Tightening: T = F L (L lever of tightening) and F = (θ P/2π)/δ, so the slope of the linear part is
//
//   k = L (P/2π) / δ                                                                   (1)
//
// and the torque at which yield begins is T_y = F_y L, with the force F_y at which the tensile and torsional
// stress of a bolt of the design's class reaches its limit. F_y depends on the friction too:
//
//   T_y = F_y(μ) L(μ)                                                                  (2)
//
// With yield, (2) gives the friction μ (one coefficient for thread and bearing) and (1) the compliance δ.
// Without yield, the friction stays that of the design and (1) gives δ. A loosening run gives the preload at
// the design's friction only: T_off = F L_off, where L_off is the lever of loosening with static friction.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "game/measure/landmarks.hpp"
#include "game/statistics/summary.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::measure {

// Measured values are means over the runs, with the standard deviation between them.
struct JointFit {
    joint::JointDesign design;                       // with the fitted values
    std::optional<statistics::MeanDeviation> slope;  // N·m/rad
    std::optional<statistics::MeanDeviation> yield;  // N·m at which yield begins; only if most runs yield
    std::optional<statistics::MeanDeviation> breakaway;  // N·m, positive
    std::optional<statistics::MeanDeviation> running;    // N·m, of the free nut
    double friction = 0.0;                               // one coefficient for thread and bearing
    bool friction_fitted = false;      // false: `friction` is the mean of the design's two coefficients
    double compliance = 0.0;           // m/N; 0: not fitted
    double members_E = 0.0;            // Pa, of all members, that gives the compliance; 0: none gives it
    double preload = 0.0;              // N, from the breakaway at the design's friction; loosening only
    std::vector<std::string> unknown;  // what the data cannot tell, one sentence each
};

// The torque, N·m, at which the mechanistic law's curve of this design begins to yield (landmarks.hpp defines
// it), if thread and bearing have this friction. The highest torque of the curve if it does not yield.
double yield_torque(const joint::JointDesign& design, double friction);

// `runs`: landmarks of the runs of one direction. Fails for tightening without a linear part or members, and
// for loosening without a breakaway.
Result<JointFit> fit_joint(const joint::JointDesign& design, std::span<const Landmarks> runs,
                           joint::Direction direction);

// A fragment of an assembly file to paste: the materials of the members, and the joint type `name` with the
// properties of the design, but without `counter_hold`, `friction_held_bearing`, `start_gap_mm` and
// `nut_mass_g`. Its specification has only the target torque (N·m).
std::string joint_type_json(const JointFit& fit, const std::string& name, double target_torque);

// The fitted values, and those that the data cannot tell, for the terminal.
std::string fit_text(const JointFit& fit);

}  // namespace bolt::measure
