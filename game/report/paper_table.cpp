// The paper's Fig. 9 and Table 2 with simulated measurements: the published law against runs of both
// materials.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "game/analysis/repetition.hpp"
#include "game/plot/html.hpp"
#include "game/report/report.hpp"

namespace bolt::report {

namespace {

struct PrintedError {
    double mre, mape;
};

// Table 2 of the paper of 2018.
constexpr std::array<PrintedError, joint::stage_count> printed_stainless{
    {{0.10592, 0.06921}, {0.12523, 0.05402}, {0.11237, 0.01481}, {0.00554, 0.00221}}};
constexpr std::array<PrintedError, joint::stage_count> printed_carbon{
    {{0.13432, 0.09927}, {0.16812, 0.08322}, {0.11369, 0.01819}, {0.00684, 0.00324}}};

const std::array<PrintedError, joint::stage_count>* printed_for(std::string_view variant) {
    if (variant == "stainless") return &printed_stainless;
    if (variant == "carbon_steel") return &printed_carbon;
    return nullptr;
}

// One row of the table, as text.
struct TableRow {
    std::string stage, paper_mre, paper_mape, mre, mape, rmse, samples;
};

// The runs of all joint types of a material.
std::vector<analysis::CycleComparison> all_cycles(const MaterialComparison& material) {
    std::vector<analysis::CycleComparison> cycles;
    for (const analysis::Comparison& type : material.types)
        cycles.insert(cycles.end(), type.joints.front().cycles.begin(), type.joints.front().cycles.end());
    return cycles;
}

std::vector<TableRow> table_rows(const MaterialComparison& material) {
    const auto* printed = printed_for(material.variant);
    const std::vector<analysis::CycleComparison> cycles = all_cycles(material);
    const analysis::RepetitionBands bands = analysis::repetition_bands(cycles);
    analysis::TorqueErrors errors;
    for (const analysis::CycleComparison& cycle : cycles) errors = analysis::pool(errors, cycle.errors);
    std::vector<TableRow> rows;
    for (std::size_t i = 0; i < errors.stage.size(); ++i) {
        const analysis::StageError& e = errors.stage[i];
        const analysis::StageBand& band = bands.stage[i];
        TableRow row;
        row.stage = joint::name(static_cast<joint::Stage>(i));
        row.paper_mre = printed != nullptr ? plot::number((*printed)[i].mre, 5) : "–";
        row.paper_mape = printed != nullptr ? plot::number((*printed)[i].mape, 5) : "–";
        row.mre = e.count > 0 ? plot::number(e.mre, 5) : "–";
        row.mape = e.count > 0 ? plot::number(e.mape, 5) : "–";
        if (std::isfinite(band.mape.low))
            row.mape +=
                fmt::format(" [{} … {}]", plot::number(band.mape.low, 3), plot::number(band.mape.high, 3));
        row.rmse = e.count + e.below > 0 ? plot::number(e.rmse, 3) : "–";
        row.samples = fmt::format("{} / {}", e.count, e.below);
        rows.push_back(std::move(row));
    }
    return rows;
}

constexpr std::string_view warning =
    "SIMULATED: no joint was measured. The \"measured\" torques come from the mechanistic law through "
    "simulated sensors and an operator. The errors show how far the published law is from the mechanistic "
    "law, not from real joints; the paper's errors were measured on real joints.";

// The highest torque of the runs and of the published law, by joint type.
std::string summary_sentence(const MaterialComparison& material) {
    std::string out;
    for (const analysis::Comparison& type : material.types) {
        std::vector<double> peaks;
        for (const analysis::MeasuredCurve& run : type.measured)
            peaks.push_back(analysis::share_of_peak(run.curve, 1.0));
        const auto [low, high] = std::minmax_element(peaks.begin(), peaks.end());
        const analysis::JointComparison& joint = type.joints.front();
        const analysis::RepetitionBands bands = analysis::repetition_bands(joint.cycles);
        out += fmt::format("{}{}: {} runs, highest torque {} to {} N·m, published law {} N·m",
                           out.empty() ? "" : " ", joint.joint, peaks.size(), plot::number(*low, 1),
                           plot::number(*high, 1),
                           plot::number(analysis::share_of_peak(joint.simulated, 1.0), 1));
        if (std::isfinite(bands.slope_error))
            out += fmt::format(", slope in its linear stage {} % against the simulated runs",
                               plot::signed_number(100.0 * bands.slope_error, 0));
        out += ".";
        if (!joint.mismatch_reason.empty())
            out += " Another joint, so there are no errors: " + joint.mismatch_reason + ".";
    }
    return out;
}

}  // namespace

std::string paper_table_page(std::span<const MaterialComparison> materials) {
    std::string body = fmt::format(
        "<p class=\"over\">Published law against simulated measurement</p>\n<h1>Fig. 9 and Table 2, "
        "simulated</h1>\n<p><strong>{}</strong></p>\n<p class=\"note\">{}</p>\n",
        plot::escape(warning),
        materials.empty() ? "" : plot::escape(method_text(materials.front().types.front())));
    for (const MaterialComparison& material : materials) {
        plot::put(body, "<h2>{} (simulated)</h2>\n<p>{}</p>\n", plot::escape(material.variant),
                  plot::escape(summary_sentence(material)));
        body +=
            "<div class=\"scroll\"><table><thead><tr><th>stage</th><th class=\"n\">paper: MRE</th><th "
            "class=\"n\">paper: MAPE</th><th class=\"n\">simulated: MRE</th><th class=\"n\">simulated: MAPE "
            "[95 %]</th><th class=\"n\">simulated: RMSE, N·m</th><th class=\"n\">samples / below the "
            "floor</th></tr></thead><tbody>\n";
        for (const TableRow& r : table_rows(material))
            plot::put(
                body,
                "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
                "class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
                r.stage, r.paper_mre, r.paper_mape, r.mre, r.mape, r.rmse, r.samples);
        body += "</tbody></table></div>\n";
        for (const analysis::Comparison& type : material.types) body += joint_sections(type);
    }
    return plot::page("Published law against simulated measurement", body);
}

std::string paper_table_text(std::span<const MaterialComparison> materials) {
    std::string out(warning);
    out += "\n";
    for (const MaterialComparison& material : materials) {
        out += fmt::format("\n{} (simulated): {}\n", material.variant, summary_sentence(material));
        out += fmt::format("{:<12} {:>10} {:>10} {:>10} {:>28} {:>10} {:>16}\n", "stage", "paper MRE",
                           "paper MAPE", "MRE", "MAPE [95 %]", "RMSE, N·m", "samples / floor");
        for (const TableRow& r : table_rows(material))
            out += fmt::format("{:<12} {:>10} {:>10} {:>10} {:>28} {:>10} {:>16}\n", r.stage, r.paper_mre,
                               r.paper_mape, r.mre, r.mape, r.rmse, r.samples);
    }
    return out;
}

}  // namespace bolt::report
