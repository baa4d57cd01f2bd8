#include "game/analysis/errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// An angle that was shifted there and back is the same to this, rad.
constexpr double slack = 1e-9;

struct Reading {
    double torque = 0.0;
    joint::Stage stage = joint::Stage::navigation;
};

Reading read_at(const analysis::Curve& curve, double angle) {
    const auto after = std::upper_bound(curve.angle.begin(), curve.angle.end(), angle);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - curve.angle.begin(), 1, std::ssize(curve.angle) - 1));
    const double part =
        std::clamp((angle - curve.angle[i - 1]) / (curve.angle[i] - curve.angle[i - 1]), 0.0, 1.0);
    return {curve.torque[i - 1] + part * (curve.torque[i] - curve.torque[i - 1]),
            curve.stage[part < 1.0 ? i - 1 : i]};
}

// While collecting, mape holds the sum.
void collect(StageError& error, double relative) {
    ++error.count;
    error.mre = std::max(error.mre, relative);
    error.mape += relative;
}

void finish(StageError& error) {
    error.mape = error.count > 0 ? error.mape / static_cast<double>(error.count) : nan;
    if (error.count == 0) error.mre = nan;
}

StageError pool(const StageError& a, const StageError& b) {
    StageError sum;
    sum.below = a.below + b.below;
    for (const StageError& e : {a, b}) {
        if (e.count == 0) continue;
        sum.count += e.count;
        sum.mre = std::max(sum.mre, e.mre);
        sum.mape += e.mape * static_cast<double>(e.count);
    }
    finish(sum);
    return sum;
}

}  // namespace

Errors errors_of(const analysis::Curve& ours, const analysis::Curve& measured, double shift, double floor) {
    Errors errors;
    errors.floor = floor;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        const double angle = measured.angle[i] + shift;
        const bool inside =
            ours.size() > 1 && angle >= ours.angle.front() - slack && angle <= ours.angle.back() + slack;
        if (!inside) {
            ++errors.outside;
            continue;
        }
        const Reading reading = read_at(ours, angle);
        const double actual = measured.torque[i];
        StageError& stage = errors.stage[static_cast<std::size_t>(reading.stage)];
        if (std::abs(actual) < floor || actual == 0.0) {
            ++stage.below;
            ++errors.all.below;
            continue;
        }
        const double relative = std::abs(reading.torque - actual) / std::abs(actual);
        collect(stage, relative);
        collect(errors.all, relative);
    }
    for (StageError& stage : errors.stage) finish(stage);
    finish(errors.all);
    return errors;
}

Errors pool(const Errors& a, const Errors& b) {
    Errors sum;
    for (std::size_t i = 0; i < sum.stage.size(); ++i) sum.stage[i] = pool(a.stage[i], b.stage[i]);
    sum.all = pool(a.all, b.all);
    sum.outside = a.outside + b.outside;
    sum.floor = std::max(a.floor, b.floor);
    return sum;
}

double floor_of(const analysis::Curve& measured, double share) {
    double highest = 0.0;
    for (const double torque : measured.torque) highest = std::max(highest, std::abs(torque));
    return share * highest;
}

}  // namespace bolt::analysis
