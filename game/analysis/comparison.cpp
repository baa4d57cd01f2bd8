#include "game/analysis/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"
#include "game/analysis/same_joint.hpp"
#include "game/analysis/session_data.hpp"

namespace bolt::analysis {

namespace {
constexpr std::size_t max_samples = std::size_t{1} << 18U;
constexpr double min_step = 1e-6;  // rad
constexpr double min_turn = to_radians(1.0);
}  // namespace

TorqueCurveBuilder::TorqueCurveBuilder(joint::Direction direction)
    : sign_(direction == joint::Direction::tighten ? 1.0 : -1.0), step_(min_step) {
    curve_.direction = direction;
}

void TorqueCurveBuilder::restart(double nut_angle, double torque, joint::Stage stage) {
    curve_.angle.assign(1, 0.0);
    curve_.torque.assign(1, torque);
    curve_.stage.assign(1, stage);
    curve_.skipped = 0;
    origin_ = nut_angle;
    anchor_ = 0.0;
}

// Keeps the sample with more torque of each pair, which preserves peaks.
void TorqueCurveBuilder::thin() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < curve_.size(); i += 2, ++kept) {
        const bool second =
            i + 1 < curve_.size() && std::abs(curve_.torque[i + 1]) > std::abs(curve_.torque[i]);
        const std::size_t from = second ? i + 1 : i;
        curve_.angle[kept] = curve_.angle[from];
        curve_.torque[kept] = curve_.torque[from];
        curve_.stage[kept] = curve_.stage[from];
    }
    curve_.angle.resize(kept);
    curve_.torque.resize(kept);
    curve_.stage.resize(kept);
    step_ = std::max(2.0 * step_, curve_.angle.back() / static_cast<double>(max_samples));
}

void TorqueCurveBuilder::add(double nut_angle, double torque, joint::Stage stage) {
    if (!std::isfinite(nut_angle) || !std::isfinite(torque)) return;
    const bool loosening = curve_.direction == joint::Direction::loosen;
    if (curve_.empty() || (loosening && nut_angle > origin_ + step_)) {
        restart(nut_angle, torque, stage);
        return;
    }
    const double turned = sign_ * (nut_angle - origin_);
    if (curve_.size() == 1 && turned <= step_) {
        if (sign_ * torque > sign_ * curve_.torque[0]) curve_.torque[0] = torque;
        ++curve_.skipped;
        return;
    }
    if (turned <= anchor_ + step_) {
        // Within a step, keep the sample with more torque, which preserves peaks.
        const bool further = turned > curve_.angle.back() + min_step;
        if (further && std::abs(torque) > std::abs(curve_.torque.back())) {
            curve_.angle.back() = turned;
            curve_.torque.back() = torque;
            curve_.stage.back() = stage;
        }
        if (!further) ++curve_.skipped;
        return;
    }
    if (curve_.size() == max_samples) thin();
    anchor_ = turned;
    curve_.angle.push_back(turned);
    curve_.torque.push_back(torque);
    curve_.stage.push_back(stage);
}

TorqueCurve TorqueCurveBuilder::finish() { return std::move(curve_); }

TorqueCurve make_torque_curve(std::span<const double> angle, std::span<const double> torque,
                              joint::Direction direction) {
    // A rig may count its angle upwards in both directions; the first and the last angle give its sign.
    const std::size_t count = std::min(angle.size(), torque.size());
    if (count == 0) return {};
    const double rig_sign = angle[count - 1] >= angle[0] ? 1.0 : -1.0;
    const double sign = direction == joint::Direction::tighten ? 1.0 : -1.0;
    TorqueCurveBuilder builder(direction);
    for (std::size_t i = 0; i < count; ++i)
        builder.add(sign * rig_sign * (angle[i] - angle[0]), torque[i], joint::Stage::navigation);
    TorqueCurve curve = builder.finish();
    curve.stage.clear();
    return curve;
}

Result<std::vector<std::optional<TorqueCurve>>> torque_curves(const session::SessionReader& session,
                                                              std::size_t joints,
                                                              joint::Direction direction) {
    std::vector<TorqueCurveBuilder> builders(joints, TorqueCurveBuilder(direction));
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t, std::span<const session::TickRecord> ticks) {
        for (const session::TickRecord& tick : ticks) {
            if (tick.joint < 0 || static_cast<std::size_t>(tick.joint) >= joints) continue;
            const auto stage = static_cast<joint::Stage>(std::min<int>(tick.stage, joint::stage_count - 1));
            builders[static_cast<std::size_t>(tick.joint)].add(
                static_cast<double>(tick.nut_angle), static_cast<double>(tick.wrench_torque), stage);
        }
    }));
    std::vector<std::optional<TorqueCurve>> curves;
    for (TorqueCurveBuilder& builder : builders) {
        TorqueCurve curve = builder.finish();
        const double sign = direction == joint::Direction::tighten ? 1.0 : -1.0;
        const bool loaded =
            std::any_of(curve.torque.begin(), curve.torque.end(), [&](double t) { return sign * t > 0.0; });
        const bool turned = !curve.empty() && curve.angle.back() >= min_turn;
        curves.push_back(loaded && turned ? std::optional<TorqueCurve>(std::move(curve)) : std::nullopt);
    }
    return curves;
}

namespace {

// Interpolated angle at which the torque first passes `level`.
double angle_at(const TorqueCurve& curve, double level) {
    std::size_t i = 0;
    while (i < curve.size() && curve.torque[i] < level) ++i;
    if (i == 0) return curve.angle.front();
    if (i == curve.size()) return curve.angle.back();
    const double rise = curve.torque[i] - curve.torque[i - 1];
    const double part = rise > 0.0 ? (level - curve.torque[i - 1]) / rise : 1.0;
    return curve.angle[i - 1] + part * (curve.angle[i] - curve.angle[i - 1]);
}

double highest_torque(const TorqueCurve& curve) {
    return *std::max_element(curve.torque.begin(), curve.torque.end());
}

std::size_t breakaway_index(const TorqueCurve& curve) {
    return static_cast<std::size_t>(std::min_element(curve.torque.begin(), curve.torque.end()) -
                                    curve.torque.begin());
}

}  // namespace

Result<Alignment> align(const TorqueCurve& simulated, const TorqueCurve& measured, double share) {
    if (simulated.empty() || measured.empty())
        return fail(ErrorCode::failed, "there is no curve to align", "two curves with samples");
    Alignment a;
    if (measured.direction == joint::Direction::loosen) {
        const std::size_t simulated_index = breakaway_index(simulated),
                          measured_index = breakaway_index(measured);
        a.simulated_angle = simulated.angle[simulated_index];
        a.measured_angle = measured.angle[measured_index];
        a.torque = measured.torque[measured_index];
    } else {
        const double end = std::min(highest_torque(simulated), highest_torque(measured));
        if (!(end > 0.0))
            return fail(ErrorCode::failed, "the curves share no tightening torque to align them by",
                        "positive torque in both");
        a.torque = share * end;
        a.simulated_angle = angle_at(simulated, a.torque);
        a.measured_angle = angle_at(measured, a.torque);
    }
    a.shift = a.simulated_angle - a.measured_angle;
    return a;
}

namespace {

// rad, rounding error of a shifted angle.
constexpr double angle_tolerance = 1e-9;

struct CurveValue {
    double torque = 0.0;
    joint::Stage stage = joint::Stage::navigation;
};

CurveValue value_at(const TorqueCurve& curve, double angle) {
    const auto after = std::upper_bound(curve.angle.begin(), curve.angle.end(), angle);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - curve.angle.begin(), 1, std::ssize(curve.angle) - 1));
    const double part =
        std::clamp((angle - curve.angle[i - 1]) / (curve.angle[i] - curve.angle[i - 1]), 0.0, 1.0);
    return {curve.torque[i - 1] + part * (curve.torque[i] - curve.torque[i - 1]),
            curve.stage[part < 1.0 ? i - 1 : i]};
}

// Until finish_error(), mape and rmse hold sums. `above`: the measured torque is not below the floor;
// `for_mre`: nor near zero.
void add_error(StageError& error, double difference, double actual, bool above, bool for_mre) {
    error.rmse += difference * difference;
    if (!above) {
        ++error.below;
        return;
    }
    const double relative = std::abs(difference) / std::abs(actual);
    ++error.count;
    if (for_mre) error.mre = std::fmax(error.mre, relative);  // replaces NaN
    error.mape += relative;
}

void finish_error(StageError& error) {
    const std::size_t samples = error.count + error.below;
    error.rmse = samples > 0 ? std::sqrt(error.rmse / static_cast<double>(samples)) : nan;
    error.mape = error.count > 0 ? error.mape / static_cast<double>(error.count) : nan;
}

StageError pool(const StageError& a, const StageError& b) {
    StageError sum;
    sum.below = a.below + b.below;
    for (const StageError& e : {a, b}) {
        if (e.count + e.below > 0) sum.rmse += square(e.rmse) * static_cast<double>(e.count + e.below);
        if (e.count == 0) continue;
        sum.count += e.count;
        sum.mre = std::fmax(sum.mre, e.mre);
        sum.mape += e.mape * static_cast<double>(e.count);
    }
    finish_error(sum);
    return sum;
}

}  // namespace

TorqueErrors torque_errors(const TorqueCurve& simulated, const TorqueCurve& measured, double shift,
                           double floor, double mre_floor) {
    TorqueErrors errors;
    errors.relative_error_floor = floor;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        const double angle = measured.angle[i] + shift;
        const bool inside = simulated.size() > 1 && angle >= simulated.angle.front() - angle_tolerance &&
                            angle <= simulated.angle.back() + angle_tolerance;
        if (!inside) {
            ++errors.outside;
            continue;
        }
        const CurveValue value = value_at(simulated, angle);
        const double actual = measured.torque[i];
        const bool above = std::abs(actual) >= floor && actual != 0.0;
        for (StageError* error : {&errors.stage[static_cast<std::size_t>(value.stage)], &errors.all})
            add_error(*error, value.torque - actual, actual, above, std::abs(actual) >= mre_floor);
    }
    for (StageError& stage : errors.stage) finish_error(stage);
    finish_error(errors.all);
    return errors;
}

double slope_error(const TorqueCurve& simulated, const TorqueCurve& measured, double shift) {
    // Sums of the angle x, the measured torque y and the simulated torque v, from the first sample on.
    double n = 0.0, sx = 0.0, sy = 0.0, sv = 0.0, sxx = 0.0, sxy = 0.0, sxv = 0.0;
    double x0 = 0.0;
    for (std::size_t i = 0; i < measured.size() && simulated.size() > 1; ++i) {
        const double angle = measured.angle[i] + shift;
        if (angle < simulated.angle.front() || angle > simulated.angle.back()) continue;
        const CurveValue value = value_at(simulated, angle);
        if (value.stage != joint::Stage::linearity) continue;
        if (n == 0.0) x0 = angle;
        const double x = angle - x0, y = measured.torque[i], v = value.torque;
        n += 1.0;
        sx += x;
        sy += y;
        sv += v;
        sxx += x * x;
        sxy += x * y;
        sxv += x * v;
    }
    const double rise = n * sxy - sx * sy;
    if (n < 4.0 || !(n * sxx - sx * sx > 0.0) || !(rise > 0.0)) return nan;
    return (n * sxv - sx * sv) / rise - 1.0;
}

TorqueErrors pool(const TorqueErrors& a, const TorqueErrors& b) {
    TorqueErrors sum;
    for (std::size_t i = 0; i < sum.stage.size(); ++i) sum.stage[i] = pool(a.stage[i], b.stage[i]);
    sum.all = pool(a.all, b.all);
    sum.outside = a.outside + b.outside;
    sum.relative_error_floor = std::max(a.relative_error_floor, b.relative_error_floor);
    return sum;
}

double share_of_peak(const TorqueCurve& curve, double share) {
    double highest = 0.0;
    for (const double torque : curve.torque) highest = std::max(highest, std::abs(torque));
    return share * highest;
}

namespace {

std::vector<std::string> ids_of(const content::Assembly& assembly) {
    std::vector<std::string> ids;
    for (const content::AssemblyJoint& joint : assembly.joints) ids.push_back(joint.design.id);
    return ids;
}

tl::unexpected<Error> unknown_joint(std::string_view joint, const std::vector<std::string>& ids) {
    const std::string near = nearest(joint, ids);
    return fail(ErrorCode::usage, fmt::format("there is no joint \"{}\" in the session", joint),
                near.empty() ? fmt::format("one of {}", fmt::join(ids, ", "))
                             : fmt::format("did you mean \"{}\"?", near));
}

std::string_view verb(joint::Direction direction) {
    return direction == joint::Direction::tighten ? "tightened" : "loosened";
}

}  // namespace

std::vector<MeasuredCurve> measured_curves(const MeasuredRecord& measured) {
    std::vector<MeasuredCurve> curves;
    for (const Cycle& cycle : measured.cycles)
        curves.push_back({cycle.name, make_torque_curve(cycle.angle, cycle.torque, measured.direction)});
    return curves;
}

namespace {

void add_errors(const TorqueCurve& simulated, const TorqueCurve& measured, const ComparisonOptions& options,
                CycleComparison& cycle) {
    const double shift = cycle.alignment.shift;
    cycle.errors = torque_errors(simulated, measured, shift, share_of_peak(measured, options.floor_share),
                                 share_of_peak(measured, options.mre_floor_share));
    if (measured.direction == joint::Direction::loosen)
        cycle.breakaway_error =
            simulated.torque[breakaway_index(simulated)] / measured.torque[breakaway_index(measured)] - 1.0;
    else
        cycle.slope_error = slope_error(simulated, measured, shift);
}

// Removes the errors of a joint that is another one.
void drop_errors(JointComparison& joint, const std::string& why) {
    joint.mismatch_reason = why;
    joint.errors = {};
    for (CycleComparison& cycle : joint.cycles) {
        cycle.errors = {};
        cycle.slope_error = cycle.breakaway_error = nan;
    }
}

}  // namespace

Result<JointComparison> compare_joint(std::string joint, TorqueCurve simulated,
                                      const std::vector<MeasuredCurve>& measured,
                                      const ComparisonOptions& options) {
    JointComparison result;
    result.joint = std::move(joint);
    result.simulated = std::move(simulated);
    for (const MeasuredCurve& cycle : measured) {
        CycleComparison one;
        BOLT_TRY_ASSIGN(const auto alignment, align(result.simulated, cycle.curve, options.share));
        one.alignment = alignment;
        add_errors(result.simulated, cycle.curve, options, one);
        result.errors = pool(result.errors, one.errors);
        result.cycles.push_back(one);
    }
    if (options.same_joint) return result;
    std::string other = different_peaks(result.simulated, measured);
    if (other.empty()) other = different_slopes(result.simulated, measured, result.cycles);
    if (!other.empty()) drop_errors(result, other);
    return result;
}

Result<Comparison> compare(const session::SessionReader& session, const MeasuredRecord& measured,
                           std::string_view joint, const ComparisonOptions& options) {
    BOLT_TRY_ASSIGN(const auto assembly, stored_assembly(session));
    const std::vector<std::string> ids = ids_of(assembly);
    if (!joint.empty() && std::find(ids.begin(), ids.end(), joint) == ids.end())
        return unknown_joint(joint, ids);

    BOLT_TRY_ASSIGN(const auto bolt, recorded_bolt(measured));
    BOLT_TRY_ASSIGN(auto simulated, torque_curves(session, ids.size(), measured.direction));

    Comparison result;
    result.session = session.file();
    result.title = title_of(assembly);
    result.law = joint::name(session.header().law);
    result.variant = session.header().variant;
    result.measured_file = measured.file;
    result.source = measured.source;
    result.thread = measured.thread;
    result.direction = measured.direction;
    result.measured = measured_curves(measured);
    result.options = options;
    for (std::size_t j = 0; j < ids.size(); ++j) {
        if (!simulated[j] || (!joint.empty() && ids[j] != joint)) continue;
        const std::string other = different_bolt(assembly.joints[j].design, bolt);
        BOLT_TRY_ASSIGN(auto one, compare_joint(ids[j], std::move(*simulated[j]), result.measured, options));
        if (!other.empty()) drop_errors(one, other);
        result.errors = pool(result.errors, one.errors);
        result.joints.push_back(std::move(one));
    }
    if (result.joints.empty()) {
        Error error;
        error.file = session.file();
        error.what = joint.empty() ? fmt::format("no joint was {} in this session", verb(measured.direction))
                                   : fmt::format("joint '{}' was not {} in this session", joint,
                                                 verb(measured.direction));
        error.expected =
            fmt::format("a session in which it was {}, as in {}", verb(measured.direction), measured.file);
        return fail(std::move(error));
    }
    return result;
}

}  // namespace bolt::analysis
