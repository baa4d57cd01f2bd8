#include "game/measure/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "engine/base/math.hpp"
#include "game/measure/landmarks.hpp"
#include "game/measure/table.hpp"
#include "game/statistics/summary.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::measure {

namespace {

// The law's loosening curve after tightening to `torque`, and the preload it starts from.
struct LooseningCurve {
    analysis::TorqueCurve curve;
    double preload = 0.0;  // N
};

LooseningCurve law_loosening(const joint::JointDesign& design, double torque) {
    joint::CurveOptions options;
    options.direction = joint::Direction::loosen;
    options.torque = torque;
    analysis::TorqueCurveBuilder builder(joint::Direction::loosen);
    LooseningCurve result;
    for (const joint::CurveSample& s :
         joint::torque_angle_curve(joint::make_group({&design, 1}, nullptr, 0), options)) {
        builder.add(-s.angle, s.torque, s.stage);
        result.preload = std::max(result.preload, s.clamp);
    }
    result.curve = builder.finish();
    return result;
}

// From the breakaway to 5 % of it, rad; NaN if the curve ends before.
double release_of(const Landmarks& l) { return l.released ? *l.released - l.peak.angle : nan; }

// The curve whose breakaway is `breakaway` (N·m, positive): the tightening torque is bisected.
std::optional<LooseningCurve> curve_with_breakaway(const joint::JointDesign& design, double breakaway) {
    // Loosening needs 0.6 to 1.2 times the torque of tightening at a friction of 0.08 or more.
    double low = 0.05 * breakaway, high = 2.5 * breakaway;
    LooseningCurve curve;
    for (int i = 0; i < 30; ++i) {
        const double middle = 0.5 * (low + high);
        curve = law_loosening(design, middle);
        if (curve.curve.empty()) return std::nullopt;
        const double peak = analysis::share_of_peak(curve.curve, 1.0);
        (peak < breakaway ? low : high) = middle;
    }
    if (std::abs(analysis::share_of_peak(curve.curve, 1.0) - breakaway) > 0.01 * breakaway)
        return std::nullopt;
    return curve;
}

// K = T/(F d) of repeated tightening to `torque`.
std::vector<double> law_factors(joint::JointDesign design, double friction, double torque, std::size_t uses) {
    design.friction.thread = design.friction.bearing = friction;
    const joint::GroupParameters group = joint::make_group({&design, 1}, nullptr, 0);
    std::vector<joint::JointState> joints = joint::initial_state(group, 1);
    std::vector<double> factors;
    constexpr double step = 1e-3;        // rad in a tick of 1 ms
    constexpr int most_steps = 200'000;  // per tightening; a joint that never reaches the torque ends there
    for (std::size_t use = 0; use < uses; ++use) {
        for (int i = 0; i < most_steps && joints[0].torque < torque; ++i)
            joint::turn_nut(group, joints, 0, joints[0].nut.angle + step, 1.0, 1e-3);
        factors.push_back(joints[0].torque / joints[0].clamp / design.thread.thread.d);
        for (int i = 0; i < most_steps && joints[0].clamp > 1.0; ++i)
            joint::turn_nut(group, joints, 0, joints[0].nut.angle - step, -1.0, 1e-3);
        joints[0].torque = 0.0;
    }
    return factors;
}

double friction_for(const joint::JointDesign& design, double torque, double factor) {
    double low = 0.02, high = 0.6;
    for (int i = 0; i < 25; ++i) {
        const double middle = 0.5 * (low + high);
        (law_factors(design, middle, torque, 1).front() < factor ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

std::optional<joint::Lubrication> lubrication_named(std::string_view name) {
    if (name == "oiled") return joint::Lubrication::oiled;
    if (name == "dry") return joint::Lubrication::dry;
    if (name == "mos2") return joint::Lubrication::mos2;
    if (name == "asis") return joint::Lubrication::as_received;
    return std::nullopt;
}

std::string printed_name(joint::Lubrication lubrication) {
    switch (lubrication) {
        case joint::Lubrication::oiled:
            return "oiled";
        case joint::Lubrication::dry:
            return "dry";
        case joint::Lubrication::mos2:
            return "MoS2";
        case joint::Lubrication::as_received:
            break;
    }
    return "as received";
}

}  // namespace

Result<LooseningValidation> validate_loosening(const joint::JointDesign& design,
                                               const analysis::MeasuredRecord& record) {
    LooseningValidation v;
    v.comparison.title = design.id;
    v.comparison.law = "mechanistic";
    v.comparison.measured_file = record.file;
    v.comparison.source = record.source;
    v.comparison.thread = record.thread;
    v.comparison.direction = record.direction;
    v.comparison.measured = analysis::measured_curves(record);
    std::vector<double> breakaways, releases, steps;
    for (const analysis::MeasuredCurve& run : v.comparison.measured) {
        const Landmarks l = find_landmarks(run.curve);
        breakaways.push_back(std::abs(l.peak.torque));
        if (const double release = release_of(l); std::isfinite(release)) releases.push_back(release);
        if (run.curve.size() > 1)
            steps.push_back(run.curve.angle.back() / static_cast<double>(run.curve.size() - 1));
    }
    const statistics::MeanDeviation breakaway = statistics::mean_deviation(breakaways);
    const statistics::Quartiles release = statistics::quartiles(releases);
    v.breakaway = breakaway.mean;
    v.breakaway_deviation = breakaway.deviation;
    v.release_low = release.low;
    v.release = release.median;
    v.release_high = release.high;
    v.resolution = statistics::mean_deviation(steps).mean;
    auto law = curve_with_breakaway(design, v.breakaway);
    if (!law || record.direction != joint::Direction::loosen)
        return fail(ErrorCode::failed, record.file + ": no preload gives the measured breakaway torque",
                    "loosening runs of the joint " + design.id);
    v.preload = law->preload;
    v.law_release = release_of(find_landmarks(law->curve));
    for (const double angle : releases) {
        if (angle > v.law_release + v.resolution) ++v.longer;
        if (angle < v.law_release - v.resolution) ++v.shorter;
    }
    v.comparison.options.same_joint = true;  // the design describes the measured joint
    BOLT_TRY_ASSIGN(auto joint, analysis::compare_joint(design.id, std::move(law->curve),
                                                        v.comparison.measured, v.comparison.options));
    v.comparison.errors = joint.errors;
    v.comparison.joints.push_back(std::move(joint));
    return v;
}

std::string loosening_text(const LooseningValidation& v) {
    const analysis::TorqueErrors& e = v.comparison.errors;
    std::string out = fmt::format("## {}: {} measured loosening runs\n\n{}\n\n", v.comparison.title,
                                  v.comparison.measured.size(), v.comparison.source);
    out += "| | measured | law |\n|---|---|---|\n";
    out += fmt::format("| breakaway, N·m | {:.2f} ± {:.2f} | fitted: preload {:.2f} kN |\n", v.breakaway,
                       v.breakaway_deviation, v.preload / 1e3);
    out += fmt::format(
        "| breakaway to 5 % of it, °: median (quartiles) | {:.1f} ({:.1f} … {:.1f}), samples every {:.1f}° | "
        "{:.1f} |\n",
        to_degrees(v.release), to_degrees(v.release_low), to_degrees(v.release_high),
        to_degrees(v.resolution), to_degrees(v.law_release));
    out += fmt::format("| RMSE over all stages, N·m | | {:.3f} |\n", e.all.rmse);
    out += fmt::format("| MAPE, samples above 1 % of the peak | | {:.2f} |\n\n", e.all.mape);
    const std::size_t runs = v.comparison.measured.size();
    const std::string course = 2 * v.longer > runs ? "The law loses its load too early"
                               : 2 * v.shorter > runs
                                   ? "The law keeps its load too long"
                                   : "The law's release angle agrees with most runs within a sample";
    out += fmt::format(
        "Verdict: the breakaway is no test, because preload, friction and joint are unknown; the law does "
        "not predict its scatter of {:.0f} % between runs either. {}: of {} runs {} take more than one "
        "sample longer than the law and {} are more than one sample shorter. The bolt's length and the parts "
        "are assumptions; a softer joint releases later, so a difference is no proof against the law. With "
        "samples every {:.1f}° the peak itself may lie between two samples, so errors of single samples say "
        "little.\n\n",
        100.0 * v.breakaway_deviation / v.breakaway, course, runs, v.longer, v.shorter,
        to_degrees(v.resolution));
    return out;
}

Result<Validation> validate_retightening(const joint::JointDesign& design, double torque,
                                         std::string_view table, const std::string& file) {
    const std::vector<std::string> wanted{"K=T/(F d)"};
    BOLT_TRY_ASSIGN(const auto data, parse_table(table, file, {}, wanted, "lube"));
    std::map<std::string, std::vector<double>> series;
    for (std::size_t row = 0; row < data.rows(); ++row)
        series[data.labels[row]].push_back(data.columns[0][row]);
    Validation v;
    v.title = fmt::format("{}: re-tightening to {:g} N·m", design.id, torque);
    v.source = "Acta Polytechnica Hungarica 21(2) (2024) 133–150, figures digitised. K = T/(F d).";
    v.x_label = "tightening";
    v.y_label = "K";
    v.caption = "Open rings: measured. Dots: the law.";
    v.is_sequence = true;
    std::string out = fmt::format(
        "## {}\n\n{}\n\n"
        "| lubrication | friction, fitted to the first | first K | last K measured | last K law | MAPE of K "
        "| largest error |\n|---|---|---|---|---|---|---|\n",
        v.title, v.source);
    double worst = 0.0;
    for (const auto& [name, measured] : series) {
        const auto lubrication = lubrication_named(name);
        if (!lubrication)
            return fail(data.error(0, fmt::format("lubrication '{}' is not known", name),
                                   "oiled, dry, mos2 or asis"));
        joint::JointDesign joint = design;
        joint.friction.lubrication = *lubrication;
        const double friction = friction_for(joint, torque, measured.front());
        const std::vector<double> law = law_factors(joint, friction, torque, measured.size());
        ValidationSeries shown{printed_name(*lubrication), {}, measured, law};
        for (std::size_t use = 1; use <= measured.size(); ++use) shown.x.push_back(static_cast<double>(use));
        v.series.push_back(std::move(shown));
        double sum = 0.0, largest = 0.0;
        for (std::size_t i = 1; i < measured.size(); ++i) {
            const double error = std::abs(law[i] - measured[i]) / measured[i];
            sum += error;
            largest = std::max(largest, error);
        }
        worst = std::max(worst, largest);
        out +=
            fmt::format("| {} | {:.3f} | {:.4f} | {:.4f} | {:.4f} | {:.3f} | {:.3f} |\n",
                        printed_name(*lubrication), friction, measured.front(), measured.back(), law.back(),
                        measured.size() > 1 ? sum / static_cast<double>(measured.size() - 1) : nan, largest);
    }
    v.verdict = fmt::format(
        "the law's wear was chosen after this very series (signs and sizes), so this shows how well its "
        "two terms describe the series, up to {:.0f} % off, and is no independent test. Another lubricant, "
        "size or torque is not covered.",
        100.0 * worst);
    v.text = out + "\nVerdict: " + v.verdict + "\n\n";
    return v;
}

Result<Validation> validate_preload_table(std::string_view table, const std::string& file) {
    const std::vector<std::string> wanted{"mu", "FM_kN", "MA_Nm"};
    BOLT_TRY_ASSIGN(const auto sizes, parse_table(table, file, {}, wanted, "size"));
    BOLT_TRY_ASSIGN(const auto classes, parse_table(table, file, {}, wanted, "class"));
    Validation v;
    v.title = "Table A1 of VDI 2230-1: preload and torque at 90 % of yield";
    v.source =
        "VDI 2230 part 1, table A1. The torque of each row: the computed value against the printed one.";
    v.x_label = "printed torque, kN·m";
    v.y_label = "error, %";
    v.caption = "Dots: the computed torque is larger than the printed one by this share.";
    std::map<std::string, ValidationSeries> series;
    std::map<std::string, std::array<double, 5>>
        by_class;  // rows, sums and maxima of force and torque errors
    for (std::size_t row = 0; row < sizes.rows(); ++row) {
        BOLT_TRY_ASSIGN(const auto thread, joint::parse_thread(sizes.labels[row]));
        BOLT_TRY_ASSIGN(const auto bolt, joint::property_class(classes.labels[row], thread.size.d));
        const double mu = sizes.columns[0][row];
        const joint::AssemblyPreload p =
            joint::assembly_preload(thread.thread, bolt, mu, mu,
                                    joint::bearing_mean_diameter(thread.size.head_bearing, thread.size.hole));
        const double force = std::abs(p.force / (1e3 * sizes.columns[1][row]) - 1.0),
                     torque_error = p.torque / sizes.columns[2][row] - 1.0;
        ValidationSeries& shown = series[classes.labels[row]];
        shown.name = "class " + classes.labels[row];
        shown.x.push_back(1e-3 * sizes.columns[2][row]);
        shown.law.push_back(100.0 * torque_error);
        auto& sums = by_class[classes.labels[row]];
        sums[0] += 1.0;
        sums[1] += force;
        sums[2] += std::abs(torque_error);
        sums[3] = std::max(sums[3], force);
        sums[4] = std::max(sums[4], std::abs(torque_error));
    }
    for (auto& [name, one] : series) v.series.push_back(std::move(one));
    std::string out = "## " + v.title +
                      "\n\n"
                      "| class | rows | force: mean error | largest | torque: mean error | largest "
                      "|\n|---|---|---|---|---|---|\n";
    double worst = 0.0;
    for (const auto& [name, s] : by_class) {
        out += fmt::format("| {} | {:.0f} | {:.4f} | {:.4f} | {:.4f} | {:.4f} |\n", name, s[0], s[1] / s[0],
                           s[3], s[2] / s[0], s[4]);
        worst = std::max({worst, s[3], s[4]});
    }
    v.verdict = fmt::format(
        "nothing is fitted; the largest error of {:.1f} % contains the rounding of the printed figures. "
        "The table is computed itself, not measured: it tests our formulas, not bolts.",
        100.0 * worst);
    v.text = out + "\nVerdict: " + v.verdict + "\n\n";
    return v;
}

}  // namespace bolt::measure
