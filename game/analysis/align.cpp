#include "game/analysis/align.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::analysis {

namespace {

// Angle at which the torque first passes the level, between samples.
double passing(const analysis::Curve& curve, double level) {
    std::size_t i = 0;
    while (i < curve.size() && curve.torque[i] < level) ++i;
    if (i == 0) return curve.angle.front();
    if (i == curve.size()) return curve.angle.back();
    const double rise = curve.torque[i] - curve.torque[i - 1];
    const double part = rise > 0.0 ? (level - curve.torque[i - 1]) / rise : 1.0;
    return curve.angle[i - 1] + part * (curve.angle[i] - curve.angle[i - 1]);
}

double highest(const analysis::Curve& curve) {
    return *std::max_element(curve.torque.begin(), curve.torque.end());
}

std::size_t breakaway(const analysis::Curve& curve) {
    return static_cast<std::size_t>(std::min_element(curve.torque.begin(), curve.torque.end()) -
                                    curve.torque.begin());
}

}  // namespace

Result<Alignment> align(const analysis::Curve& ours, const analysis::Curve& measured, double share) {
    if (ours.empty() || measured.empty()) return fail(ErrorCode::failed, "there is no curve to align");
    Alignment a;
    if (measured.direction == joint::Direction::loosen) {
        const std::size_t our = breakaway(ours), their = breakaway(measured);
        a.our_angle = ours.angle[our];
        a.measured_angle = measured.angle[their];
        a.torque = measured.torque[their];
    } else {
        const double end = std::min(highest(ours), highest(measured));
        if (!(end > 0.0))
            return fail(ErrorCode::failed, "the curves have no torque in common to be aligned by",
                        "tightening torque in both");
        a.torque = share * end;
        a.our_angle = passing(ours, a.torque);
        a.measured_angle = passing(measured, a.torque);
    }
    a.shift = a.our_angle - a.measured_angle;
    return a;
}

}  // namespace bolt::analysis
