// Mistakes of a rig's description that only the values show: wrong units and signs, encoders that start
// again, missing samples.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/measure/import.hpp"

namespace bolt::measure {

// "12.5 N·m"
std::string quantity(double value, std::string_view unit);

// The index of the value with the largest magnitude.
std::size_t extreme_index(const std::vector<double>& values);

// Undoes the jumps of an encoder that counts one turn and starts again: angles that stay within one turn, but
// change by more than half a turn between two samples. Returns the number of jumps.
std::size_t unwrap_turns(std::vector<double>& angle);

// A change of the angle that is much larger than those of the other samples: samples are missing.
struct AngleJump {
    std::size_t sample = 0;          // after the jump
    double step = 0.0, usual = 0.0;  // rad; usual: 95 % of the steps of the moving nut are smaller
};
// `largest`, rad: the largest permitted step; 0: five times the usual one, and at least 5 degrees, because a
// nut that slips turns by a few degrees at once.
std::optional<AngleJump> find_jump(std::span<const double> angle, double largest);

// The range that a quantity of a bolted joint can have.
struct PlausibleRange {
    double low = 0.0, high = 0.0;
};

// The largest torque of a run, N·m. High: it breaks the bolt at a friction of 0.3 (T = 0.4 d A_s R_m), of the
// strongest class unless the rig names one. Low: a hundredth of the yield load of class 8.8, with friction
// near zero (0.05 d). Without a thread: the range of all threads.
PlausibleRange plausible_torque(const Rig& rig);

// The slope of torque over angle, N·m/rad: K d c P/2π with the torque coefficient K = T/(F d), the diameter
// d, the pitch P and the joint's stiffness c. High: K = 0.31 (friction 0.24) and rigid members, as thin as
// the rig's bolt length permits, or else as thick as the bolt's diameter. Low: K = 0.08 and a tenth of the
// stiffness of a bolt of the rig's length, or else of 20 diameters. None without a thread.
std::optional<PlausibleRange> plausible_slope(const Rig& rig);

// Each check fails if the values of a run are implausible, with the place in the rig's description where the
// mistake probably is.
//
// Checks range and sign of the largest torque.
Status check_torque(const Rig& rig, const RigRun& run);
// Checks that the nut turns by 1 degree to 1000 turns; tightening: that the angle rises up to the peak.
Status check_angle(const Rig& rig, const RigRun& run);
// Checks the slope of torque over angle; needs the landmarks of a tightening run.
Status check_slope(const Rig& rig, const RigRun& run);

}  // namespace bolt::measure
