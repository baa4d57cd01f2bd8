// The report as an HTML page (report.html): one session, or several attempts side by side; and the page of
// `boltwright compare`: a session beside a measured joint.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "game/analysis/session_data.hpp"
#include "game/report/attempts.hpp"
#include "game/session/session_file.hpp"

namespace bolt::report {

// "M16×180 · 8.8", or with a pitch other than the coarse one "M12×1.25×70 · 8.8".
std::string bolt_text(const content::AssemblyJoint& joint);

// HTML: "✓ OK", "▲ HIGH torque", "▼ LOW" as shape, word and colour. If the angle was judged too, a wrong
// verdict names torque, angle or both. A damaged joint shows its condition instead.
std::string verdict_mark(const lesson::JointResult& result);

// HTML of one session. `number` counts from 1 and is part of the anchor's name; 0: the only session.
std::string session_section(const analysis::SessionData& session, std::size_t number,
                            const TraineeNames& names = {});

// HTML: the haptic metrics of a session: evenness of the force, contacts with obstacles, times to reach the
// nuts, and timing of the servo. Empty if the session has neither forces nor arrivals.
std::string haptics_section(const analysis::SessionData& session);

// `overview` omits the sections of the single sessions if there are several sessions.
enum class ReportExtent : std::uint8_t { everything, overview };

// Returns the page, a single file without external resources. Its head lists the people on it,
// so that people::page_trainees finds them. Fails without sessions, or if one cannot be read. Keeps the
// curves of only one session in memory.
Result<std::string> make_report(std::span<const session::SessionReader* const> sessions,
                                ReportExtent extent = ReportExtent::everything,
                                const TraineeNames& names = {});

// As above, for data that is already read.
std::string make_report(std::span<const analysis::SessionData> sessions, const TraineeNames& names = {});

// The text of a comparison, for the terminal (comparison.cpp).
std::string console_text(const analysis::Comparison& comparison);

// A complete HTML document without external resources.
std::string comparison_page(const analysis::Comparison& comparison);

// HTML: the section of every joint of a comparison.
std::string joint_sections(const analysis::Comparison& comparison);

// Simulated runs of one material, compared with the published law of each joint type: a comparison with one
// joint for each type.
struct MaterialComparison {
    std::string variant;
    std::vector<analysis::Comparison> types;
};
// The errors of the published law beside those that the paper of 2018 prints (paper_table.cpp); page and text
// tell the reader that these values are computed, not measured. The paper has the variants "stainless" and
// "carbon_steel".
std::string paper_table_page(std::span<const MaterialComparison> materials);
std::string paper_table_text(std::span<const MaterialComparison> materials);

// A page with plots over one axis: measured values and those of the law, or the error of the law alone.
struct SeriesPlot {
    std::string name;
    std::vector<double> x, measured, law;  // `measured` may be empty
};
struct SeriesPage {
    std::string title, source, verdict, x_label, y_label;
    std::string caption;       // the meaning of rings (measured) and dots (law)
    bool is_sequence = false;  // the points of a plot follow each other; a line connects them
    std::vector<SeriesPlot> plots;
};
std::string series_page(const SeriesPage& page);

// Warnings for the reader of the comparison: peaks that differ by a large factor, stages without samples.
std::vector<std::string> remarks(const analysis::Comparison& comparison);

// Describes the alignment of the curves and the definition of the errors.
std::string method_text(const analysis::Comparison& comparison);

}  // namespace bolt::report
