#include "game/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/math.hpp"
#include "game/analysis/repetition.hpp"
#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"

namespace bolt::report {

namespace {

using plot::escape;
using plot::number;

constexpr std::size_t max_small_plots = 40;  // of single cycles of a joint

// The axes' ranges of a plot.
struct CurveExtent {
    plot::AxisRange angle;   // degrees from the common point
    plot::AxisRange torque;  // N·m
};

// The angle, rad, of the virtual curve at the common point of the first cycle: the plots' 0°.
double common_angle(const analysis::JointComparison& joint) {
    return joint.cycles.empty() ? 0.0 : joint.cycles[0].alignment.simulated_angle;
}

std::vector<plot::SvgPoint> simulated_points(const analysis::JointComparison& joint) {
    std::vector<plot::SvgPoint> points;
    for (std::size_t i = 0; i < joint.simulated.size(); ++i)
        points.push_back(
            {to_degrees(joint.simulated.angle[i] - common_angle(joint)), joint.simulated.torque[i]});
    return points;
}

std::vector<plot::SvgPoint> cycle_points(const analysis::Comparison& c,
                                         const analysis::JointComparison& joint, std::size_t cycle) {
    const analysis::TorqueCurve& curve = c.measured[cycle].curve;
    const double shift = joint.cycles[cycle].alignment.shift - common_angle(joint);
    std::vector<plot::SvgPoint> points;
    for (std::size_t i = 0; i < curve.size(); ++i)
        points.push_back({to_degrees(curve.angle[i] + shift), curve.torque[i]});
    return points;
}

// Extends the range of torques by the whole curve, and the range of angles by the samples under load: those
// above 8 % of the peak, which noise does not reach.
void add_curve(CurveExtent& extent, const std::vector<plot::SvgPoint>& points) {
    double peak = 0.0;
    for (const plot::SvgPoint& p : points) peak = std::max(peak, std::abs(p.y));
    for (const plot::SvgPoint& p : points) {
        extent.torque = {std::min(extent.torque.low, p.y), std::max(extent.torque.high, p.y)};
        if (std::abs(p.y) < 0.08 * peak) continue;
        extent.angle = {std::min(extent.angle.low, p.x), std::max(extent.angle.high, p.x)};
    }
}

plot::Plot plot_with_extent(CurveExtent extent, std::string title, double width, double height) {
    const double margin = std::max(2.0, 0.2 * extent.angle.span());
    extent.angle = {extent.angle.low - margin, extent.angle.high + margin};
    plot::Plot plot;
    plot.width = width;
    plot.height = height;
    plot.title = std::move(title);
    plot.x = {plot::degree_ticks(extent.angle, width > 400.0 ? 8 : 4), "angle from the common point, °"};
    plot.x.ticks.range = extent.angle;
    plot.y = {plot::covering_ticks(extent.torque.low, extent.torque.high, width > 400.0 ? 6 : 3),
              "torque, N·m"};
    return plot;
}

void add_stages(plot::Plot& plot, const analysis::JointComparison& joint) {
    constexpr std::string_view styles[] = {"s0", "s1", "s2", "s3"};
    const analysis::TorqueCurve& simulated = joint.simulated;
    for (std::size_t i = 0; i < simulated.size();) {
        std::size_t end = i;
        while (end + 1 < simulated.size() && simulated.stage[end + 1] == simulated.stage[i]) ++end;
        const std::size_t to = std::min(end + 1, simulated.size() - 1);
        plot.bands.push_back({{to_degrees(simulated.angle[i] - common_angle(joint)),
                               to_degrees(simulated.angle[to] - common_angle(joint))},
                              styles[static_cast<std::size_t>(simulated.stage[i])],
                              std::string(joint::name(simulated.stage[i]))});
        i = end + 1;
    }
}

// The extent of all curves of one joint. The small plots share it, so that they can be compared.
CurveExtent curve_extent(const analysis::Comparison& c, const analysis::JointComparison& joint) {
    CurveExtent extent{{0.0, 0.0}, {0.0, 0.0}};
    add_curve(extent, simulated_points(joint));
    for (std::size_t i = 0; i < joint.cycles.size(); ++i) add_curve(extent, cycle_points(c, joint, i));
    return extent;
}

plot::Plot cycle_plot(const analysis::Comparison& c, const analysis::JointComparison& joint,
                      std::size_t cycle, const CurveExtent& extent) {
    plot::Plot plot = plot_with_extent(extent, fmt::format("cycle {}", c.measured[cycle].name), 220.0, 150.0);
    plot.x.label.clear();
    plot.lines.push_back({simulated_points(joint), "ln p2", false});
    plot.lines.push_back({cycle_points(c, joint, cycle), "ln me1", false});
    return plot;
}

std::string error_value(const analysis::StageError& e, double value) {
    return e.count > 0 ? number(value, 5) : "–";  // number() gives NaN a dash too
}

// " [0.012 … 0.034]"; empty without an interval.
std::string interval_text(const statistics::ConfidenceInterval& i, int decimals) {
    if (!std::isfinite(i.low)) return "";
    return fmt::format(" [{} … {}]", number(i.low, decimals), number(i.high, decimals));
}

// "−3.2 % [−4.1 … −2.2]"
std::string share_text(double share, const statistics::ConfidenceInterval& i) {
    const statistics::ConfidenceInterval percent{100.0 * i.low, 100.0 * i.high};
    return plot::signed_number(100.0 * share, 1) + " %" + interval_text(percent, 1);
}

std::string error_table(const analysis::TorqueErrors& errors, const analysis::RepetitionBands* bands) {
    std::string out =
        "<div class=\"scroll\"><table><thead><tr><th>stage</th><th class=\"n\">MRE</th><th "
        "class=\"n\">MAPE</th><th class=\"n\">RMSE, N·m</th><th class=\"n\">samples</th><th "
        "class=\"n\">below the floor</th></tr></thead><tbody>\n";
    const auto row = [&](std::string_view name, const analysis::StageError& e,
                         const analysis::StageBand* band, std::string_view style) {
        plot::put(out,
                  "<tr{}><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}{}</td><td "
                  "class=\"n\">{}{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
                  style, name, error_value(e, e.mre), error_value(e, e.mape),
                  band != nullptr ? interval_text(band->mape, 3) : "",
                  e.count + e.below > 0 ? number(e.rmse, 3) : "–",
                  band != nullptr ? interval_text(band->rmse, 3) : "", e.count, e.below);
    };
    for (std::size_t i = 0; i < errors.stage.size(); ++i)
        row(joint::name(static_cast<joint::Stage>(i)), errors.stage[i],
            bands != nullptr ? &bands->stage[i] : nullptr, "");
    row("all stages", errors.all, bands != nullptr ? &bands->all : nullptr, " class=\"sum\"");
    return out +
           fmt::format(
               "</tbody></table></div>\n<p class=\"note\">{} samples lie outside the virtual curve.</p>\n",
               errors.outside);
}

// Slope and breakaway; empty if the runs have neither.
std::string feature_text(const analysis::RepetitionBands& bands) {
    std::string out;
    if (std::isfinite(bands.slope_error))
        out += fmt::format("slope in linearity: virtual {} against measured. ",
                           share_text(bands.slope_error, bands.slope_interval));
    if (std::isfinite(bands.breakaway_error))
        out += fmt::format("breakaway: virtual {} against measured. ",
                           share_text(bands.breakaway_error, bands.breakaway_interval));
    return out;
}

// The text in place of errors if the record is of another joint.
std::string other_joint_text(const analysis::JointComparison& joint) {
    return fmt::format(
        "another joint, or the same one in another state: {}. Errors of torque, slope and breakaway would "
        "have no meaning and are left out; --same-joint computes them.",
        joint.mismatch_reason);
}

std::string cycle_table(const analysis::Comparison& c, const analysis::JointComparison& joint) {
    std::string out =
        "<details><summary>Every cycle</summary><div class=\"scroll\"><table><thead><tr><th>cycle</th><th "
        "class=\"n\">shift</th><th class=\"n\">peak, N·m</th><th class=\"n\">floor, N·m</th>";
    for (int i = 0; i < joint::stage_count; ++i)
        out +=
            fmt::format("<th class=\"n\">{}<br/>MRE / MAPE</th>", joint::name(static_cast<joint::Stage>(i)));
    out +=
        "<th class=\"n\">all<br/>MRE / MAPE</th><th class=\"n\">samples</th><th class=\"n\">left "
        "out</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < joint.cycles.size(); ++i) {
        const analysis::TorqueErrors& e = joint.cycles[i].errors;
        const std::string& name = c.measured[i].name;
        out += fmt::format(
            "<tr><td>{}</td><td class=\"n\">{}°</td><td class=\"n\">{}</td><td class=\"n\">{}</td>",
            name.empty() ? fmt::format("{}", i + 1) : escape(name),
            number(to_degrees(joint.cycles[i].alignment.shift), 1),
            number(analysis::share_of_peak(c.measured[i].curve, 1.0), 3), number(e.relative_error_floor, 3));
        for (const analysis::StageError& s : e.stage)
            out += fmt::format("<td class=\"n\">{} / {}</td>", error_value(s, s.mre), error_value(s, s.mape));
        out +=
            fmt::format("<td class=\"n\">{} / {}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
                        error_value(e.all, e.all.mre), error_value(e.all, e.all.mape), e.all.count,
                        e.all.below + e.outside + c.measured[i].curve.skipped);
    }
    return out + "</tbody></table></div></details>\n";
}

// The virtual curve and all measured cycles, aligned; 0° is the common point.
plot::Plot overlay_plot(const analysis::Comparison& c, std::size_t index) {
    const analysis::JointComparison& joint = c.joints[index];
    plot::Plot plot = plot_with_extent(
        curve_extent(c, joint), fmt::format("{}: virtual and measured torque", joint.joint), 480.0, 320.0);
    add_stages(plot, joint);
    const std::string_view style = joint.cycles.size() == 1 ? "ln me1" : "ln me";
    for (std::size_t i = 0; i < joint.cycles.size(); ++i)
        plot.lines.push_back({cycle_points(c, joint, i), style, false});
    const analysis::CurveBand band = analysis::curve_band(c.measured, joint.cycles);
    for (const std::vector<double>* edge : {&band.low, &band.high}) {
        plot::PlotLine line{{}, "ln me1", false};
        for (std::size_t i = 0; i < band.angle.size(); ++i)
            line.points.push_back({to_degrees(band.angle[i] - common_angle(joint)), (*edge)[i]});
        if (!line.points.empty()) plot.lines.push_back(std::move(line));
    }
    plot.lines.push_back({simulated_points(joint), "ln p2", false});
    return plot;
}

std::string joint_section(const analysis::Comparison& c, std::size_t index) {
    const analysis::JointComparison& joint = c.joints[index];
    std::string out = fmt::format("<h2>{}</h2>\n<div class=\"grid wide\">\n", escape(joint.joint));
    const analysis::RepetitionBands bands = analysis::repetition_bands(joint.cycles);
    const std::string caption = fmt::format(
        "Line: virtual. Thin: {} measured cycle{}.{} Shaded: stages of the virtual curve.", c.measured.size(),
        c.measured.size() == 1 ? "" : "s",
        c.measured.size() >= analysis::min_repetitions ? " Pair of lines: 95 % interval of their mean." : "");
    out += plot::figure("", plot::draw(overlay_plot(c, index)), escape(caption));
    if (!joint.mismatch_reason.empty())
        return out + "<div><p><strong>" + escape(other_joint_text(joint)) + "</strong></p></div></div>\n";
    out += "<div>" + error_table(joint.errors, &bands);
    if (const std::string features = feature_text(bands); !features.empty())
        out += "<p>" + escape(features) + "</p>\n";
    out += "</div></div>\n" + cycle_table(c, joint);
    if (c.joints.size() > 1 || c.measured.size() < 2) return out;
    const CurveExtent extent = curve_extent(c, joint);
    out += "<h2>Cycle by cycle</h2>\n<div class=\"grid tiny\">\n";
    for (std::size_t i = 0; i < std::min(c.measured.size(), max_small_plots); ++i) {
        const analysis::StageError& all = joint.cycles[i].errors.all;
        out +=
            plot::figure(fmt::format("<h3>{}</h3><span class=\"note\">MAPE {}</span>",
                                     escape(c.measured[i].name), all.count > 0 ? number(all.mape, 3) : "–"),
                         plot::draw(cycle_plot(c, joint, i, extent)), "");
    }
    out += "</div>\n";
    if (c.measured.size() > max_small_plots)
        out += fmt::format("<p class=\"note\">The first {} of {} cycles.</p>\n", max_small_plots,
                           c.measured.size());
    return out;
}

// The number of joints that the record may belong to.
std::size_t compared_joint_count(const analysis::Comparison& c) {
    return static_cast<std::size_t>(std::count_if(c.joints.begin(), c.joints.end(),
                                                  [](const auto& j) { return j.mismatch_reason.empty(); }));
}

std::string source_line(const analysis::Comparison& c) {
    return c.source.empty() ? "" : fmt::format("Measured by {}", c.source);
}

}  // namespace

std::string joint_sections(const analysis::Comparison& c) {
    std::string out;
    for (std::size_t j = 0; j < c.joints.size(); ++j) out += joint_section(c, j);
    return out;
}

std::string comparison_page(const analysis::Comparison& c) {
    std::string body =
        fmt::format("<p class=\"over\">Virtual against measured torque</p>\n<h1>{}</h1>\n", escape(c.title));
    if (!c.source.empty()) body += fmt::format("<p>{}</p>\n", escape(source_line(c)));
    body += "<dl class=\"facts\">\n" +
            plot::fact("direction", c.direction == joint::Direction::tighten ? "tightening" : "loosening") +
            plot::fact("law", c.law) + plot::fact("variant", c.variant) +
            plot::fact("cycles", fmt::format("{}", c.measured.size())) +
            plot::path_fact("session", c.session) + plot::path_fact("measured", c.measured_file) +
            "</dl>\n<p class=\"note\">";
    for (const std::string& text : remarks(c)) body += escape(text) + " ";
    body += "</p>\n";
    body += joint_sections(c);
    if (c.joints.size() > 1 && compared_joint_count(c) > 0)
        body += "<h2>All joints</h2>\n" + error_table(c.errors, nullptr);
    body += fmt::format("<footer>{}</footer>\n", escape(method_text(c)));
    return plot::page(c.title + " – virtual against measured", body);
}

namespace {

double peak_of(const analysis::TorqueCurve& curve) { return analysis::share_of_peak(curve, 1.0); }

std::string span_text(double low, double high) {
    const std::string a = number(low, 2), b = number(high, 2);
    return a == b ? a : a + "…" + b;
}

}  // namespace

std::vector<std::string> remarks(const analysis::Comparison& c) {
    std::vector<std::string> texts;
    double least = 0.0, most = 0.0;
    for (const analysis::MeasuredCurve& cycle : c.measured) {
        const double peak = peak_of(cycle.curve);
        least = least == 0.0 ? peak : std::min(least, peak);
        most = std::max(most, peak);
    }
    double virtual_least = 0.0, virtual_most = 0.0;
    for (const analysis::JointComparison& joint : c.joints) {
        const double peak = peak_of(joint.simulated);
        virtual_least = virtual_least == 0.0 ? peak : std::min(virtual_least, peak);
        virtual_most = std::max(virtual_most, peak);
    }
    texts.push_back(fmt::format("Highest torque: measured {} N·m, virtual {} N·m.", span_text(least, most),
                                span_text(virtual_least, virtual_most)));
    for (const analysis::JointComparison& joint : c.joints)
        if (!joint.mismatch_reason.empty())
            texts.push_back(fmt::format("{}: {}", joint.joint, other_joint_text(joint)));
    if (compared_joint_count(c) == 0) return texts;
    for (std::size_t i = 0; i < c.errors.stage.size(); ++i) {
        const analysis::StageError& stage = c.errors.stage[i];
        if (stage.count == 0)
            texts.push_back(fmt::format("No sample was judged in {}{}.",
                                        joint::name(static_cast<joint::Stage>(i)),
                                        stage.below > 0 ? ": all lie below the floor" : ""));
    }
    return texts;
}

std::string method_text(const analysis::Comparison& c) {
    const std::string aligned =
        c.direction == joint::Direction::tighten
            ? fmt::format("where the torque first passes {} % of the highest torque that both reach",
                          number(100.0 * c.options.share, 0))
            : std::string("by the breakaway peak");
    const std::string near_zero =
        c.options.mre_floor_share > c.options.floor_share
            ? fmt::format(", those below {} % not for the MRE, because they are near zero",
                          number(100.0 * c.options.mre_floor_share, 1))
            : "";
    return fmt::format(
        "Only samples at which the nut turns beyond all earlier angles are used; measured curves are "
        "shifted to match the virtual one {}. Error: |virtual − measured| / |measured|; MRE is its "
        "maximum, MAPE its mean; stages are those of the virtual curve. RMSE is the root mean square of "
        "virtual − measured, in N·m. Samples below {} % of their run’s highest measured torque count for "
        "the RMSE only{}; angles that the virtual curve does not have are left out. Brackets: 95 % "
        "interval over the repetitions, bootstrap of whole runs with the seed {}, from {} runs on. Virtual "
        "torque: at the wrench, true and unscaled, law “{}”.",
        aligned, number(100.0 * c.options.floor_share, 1), near_zero, analysis::band_seed,
        analysis::min_repetitions, c.law);
}

std::string console_text(const analysis::Comparison& c) {
    std::string out = fmt::format("{} against {}\n", c.session, c.measured_file);
    if (!c.source.empty()) out += fmt::format("measured by: {}\n", c.source);
    out += fmt::format("{} measured cycle{}, {}, {} joint{}, law {}\n\n", c.measured.size(),
                       c.measured.size() == 1 ? "" : "s",
                       c.direction == joint::Direction::tighten ? "tightening" : "loosening", c.joints.size(),
                       c.joints.size() == 1 ? "" : "s", c.law);
    if (compared_joint_count(c) > 0)
        out += fmt::format("{:<12} {:<12} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8}\n", "joint", "stage", "MRE",
                           "MAPE", "RMSE,N·m", "samples", "floor", "outside");
    const auto rows = [&](const std::string& joint, const analysis::TorqueErrors& errors) {
        const auto row = [&](std::string_view stage, const analysis::StageError& e,
                             const std::string& outside) {
            const auto value = [&](double v) {
                return e.count > 0 && std::isfinite(v) ? fmt::format("{:.5f}", v) : std::string("-");
            };
            out +=
                fmt::format("{:<12} {:<12} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8}\n", joint, stage, value(e.mre),
                            value(e.mape), e.count + e.below > 0 ? fmt::format("{:.3f}", e.rmse) : "-",
                            e.count, e.below, outside);
        };
        for (std::size_t i = 0; i < errors.stage.size(); ++i)
            row(joint::name(static_cast<joint::Stage>(i)), errors.stage[i], "");
        row("all", errors.all, fmt::format("{}", errors.outside));
    };
    for (const analysis::JointComparison& joint : c.joints)
        if (joint.mismatch_reason.empty()) rows(joint.joint, joint.errors);
    if (c.joints.size() > 1 && compared_joint_count(c) > 0) rows("all", c.errors);
    if (compared_joint_count(c) > 0) out += "\n";
    for (const analysis::JointComparison& joint : c.joints)
        if (const std::string text = feature_text(analysis::repetition_bands(joint.cycles)); !text.empty())
            out += joint.joint + " " + text + "\n";
    for (const std::string& text : remarks(c)) out += text + "\n";
    return out + method_text(c) + "\n";
}

}  // namespace bolt::report
