// Judges if a measured record can be of the joint that it is compared with: from the bolt that the record
// names, and from the curves.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::analysis {

// The peaks of one joint may differ by this factor. VDI 2230 table A1, at the same use of the bolt's
// strength: friction from 0.08 to 0.24 changes the torque by a factor of 2.1, and the class from 8.8 to 12.9
// by 1.7; neither alone reaches 3. Two coarse sizes (M8 to M12) change it by 3.4.
inline constexpr double largest_peak_ratio = 3.0;

// The slopes of the linear stage may differ by this factor. The slope is the product of stiffness, pitch and
// torque per clamp force. VDI 2230 gives torque-controlled tightening a factor of 1.4 at least between the
// highest and the lowest clamp force at one torque, if the torque was determined on the original joint.
inline constexpr double largest_slope_ratio = 1.4;

// The mean slopes of loosening, from the breakaway torque to 5 % of that torque, may differ by this factor.
// Two reasons for the wider limit: the loosening torque is friction minus the pitch's share, so friction
// changes it more than the tightening torque; and published runs have few samples on the slope.
inline constexpr double largest_fall_ratio = 2.0;

// Why the measured curves cannot be of a joint with this simulated curve: their median peak differs by more
// than largest_peak_ratio. Empty if they can.
std::string different_peaks(const TorqueCurve& simulated, const std::vector<MeasuredCurve>& measured);

// As above, from the median ratio of the slopes. `cycles`: the alignments of the measured curves. Empty also
// if no curve has a slope.
std::string different_slopes(const TorqueCurve& simulated, const std::vector<MeasuredCurve>& measured,
                             std::span<const CycleComparison> cycles);

// The mean slope of a loosening curve from its breakaway to 5 % of it, N·m/rad; NaN if it ends before.
double loosening_slope(const TorqueCurve& curve);

// The bolt that a record names.
struct RecordedBolt {
    std::optional<joint::ThreadSize> thread;
    std::optional<double> length;  // m
    std::string property_class;
};
// Fails if a line of the record cannot be read.
Result<RecordedBolt> recorded_bolt(const MeasuredRecord& measured);

// Why the record's bolt is not that of the design. Empty if it may be.
std::string different_bolt(const joint::JointDesign& design, const RecordedBolt& bolt);

}  // namespace bolt::analysis
