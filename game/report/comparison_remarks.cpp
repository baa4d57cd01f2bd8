#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/text.hpp"
#include "game/report/comparison.hpp"

namespace bolt::report {

namespace {

using plot::number;

double highest_of(const analysis::Curve& curve) { return analysis::floor_of(curve, 1.0); }

std::string span_text(double low, double high) {
    const std::string a = number(low, 2), b = number(high, 2);
    return a == b ? a : a + "…" + b;
}

}  // namespace

std::vector<std::string> remarks(const analysis::Comparison& c) {
    std::vector<std::string> texts;
    double least = 0.0, most = 0.0;
    for (const analysis::MeasuredCurve& cycle : c.measured) {
        const double peak = highest_of(cycle.curve);
        least = least == 0.0 ? peak : std::min(least, peak);
        most = std::max(most, peak);
    }
    double ours_least = 0.0, ours_most = 0.0;
    for (const analysis::JointComparison& joint : c.joints) {
        const double peak = highest_of(joint.ours);
        ours_least = ours_least == 0.0 ? peak : std::min(ours_least, peak);
        ours_most = std::max(ours_most, peak);
    }
    texts.push_back(fmt::format("Highest torque: measured {} N·m, virtual {} N·m.", span_text(least, most),
                                span_text(ours_least, ours_most)));
    const double ratio = std::max(ours_most / std::max(least, 1e-12), most / std::max(ours_least, 1e-12));
    if (ratio > 3.0)
        texts.push_back(
            fmt::format("The peaks differ by a factor of up to {}: these are not the same joint, and the "
                        "relative errors say so.",
                        number(ratio, 1)));
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
            ? fmt::format("where the torque first passes {} % of the end torque both reach",
                          number(100.0 * c.options.share, 0))
            : std::string("by the breakaway peak");
    return fmt::format(
        "Each curve counts an angle once, when the nut first gets there; measured curves are shifted onto "
        "the virtual one {}. "
        "Error: |virtual − measured| / |measured|; MRE is its maximum, MAPE its mean; stages are those of "
        "the virtual curve. "
        "Samples below {} % of their run’s highest measured torque are left out, as are angles the virtual "
        "curve does not "
        "have. Virtual torque: at the wrench, true and unscaled, law “{}”.",
        aligned, number(100.0 * c.options.floor_share, 1), c.law);
}

std::string console_text(const analysis::Comparison& c) {
    std::string out = fmt::format("{} against {}\n", c.session, c.measured_file);
    if (!c.source.empty()) out += fmt::format("measured by: {}\n", c.source);
    out += fmt::format("{} measured cycle{}, {}, {} joint{}, law {}\n\n", c.measured.size(),
                       c.measured.size() == 1 ? "" : "s",
                       c.direction == joint::Direction::tighten ? "tightening" : "loosening", c.joints.size(),
                       c.joints.size() == 1 ? "" : "s", c.law);
    out += fmt::format("{:<12} {:<12} {:>9} {:>9} {:>8} {:>8} {:>8}\n", "joint", "stage", "MRE", "MAPE",
                       "samples", "floor", "outside");
    const auto rows = [&](const std::string& joint, const analysis::Errors& errors) {
        const auto row = [&](std::string_view stage, const analysis::StageError& e,
                             const std::string& outside) {
            const auto value = [&](double v) {
                return e.count > 0 ? fmt::format("{:.5f}", v) : std::string("-");
            };
            out += fmt::format("{:<12} {:<12} {:>9} {:>9} {:>8} {:>8} {:>8}\n", joint, stage, value(e.mre),
                               value(e.mape), e.count, e.below, outside);
        };
        for (std::size_t i = 0; i < errors.stage.size(); ++i)
            row(joint::name(static_cast<joint::Stage>(i)), errors.stage[i], "");
        row("all", errors.all, fmt::format("{}", errors.outside));
    };
    for (const analysis::JointComparison& joint : c.joints) rows(joint.joint, joint.errors);
    if (c.joints.size() > 1) rows("all", c.errors);
    out += "\n";
    for (const std::string& text : remarks(c)) out += text + "\n";
    return out + method_text(c) + "\n";
}

}  // namespace bolt::report
