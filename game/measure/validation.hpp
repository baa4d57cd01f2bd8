// The mechanistic law against published measurements and tables: what it predicts, what had to be fitted
// first, and a verdict. Text in Markdown; `boltwright measure validate` writes docs/validation/README.md with
// it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/analysis/comparison.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::measure {

// Loosening runs of unknown preload. The preload is fitted to the mean breakaway at the design's friction, so
// only the course of the torque after the breakaway is a test.
struct LooseningValidation {
    analysis::Comparison comparison;  // the law's curve from the fitted preload, against all runs
    double preload = 0.0;             // N, fitted
    double breakaway = 0.0, breakaway_deviation = 0.0;  // N·m, measured
    // rad from the breakaway to 5 % of it, measured: quartiles, because a run may have a late bump
    double release_low = 0.0, release = 0.0, release_high = 0.0;
    std::size_t longer = 0, shorter = 0;  // runs whose release differs from the law's by more than a sample
    double law_release = 0.0;             // rad, predicted
    double resolution = 0.0;              // rad, mean step of the measured angle
};

Result<LooseningValidation> validate_loosening(const joint::JointDesign& design,
                                               const analysis::MeasuredRecord& record);
std::string loosening_text(const LooseningValidation& v);

// Values over one axis, measured and by the law, or the error of the law alone, for a page.
struct ValidationSeries {
    std::string name;
    std::vector<double> x, measured, law;  // `measured` may be empty
};
struct Validation {
    std::string title, source, verdict;
    std::string x_label, y_label, caption;
    bool is_sequence = false;  // the values of a series follow each other
    std::vector<ValidationSeries> series;
    std::string text;  // Markdown, with the verdict
};

// Re-tightening: a table with the columns lube, tightening_no and "K=T/(F d)". The friction of each state of
// lubrication is fitted to its first tightening; the change with re-use is a test. K = T/(F d). `torque`:
// N·m, of every tightening. `table`: text of the file.
Result<Validation> validate_retightening(const joint::JointDesign& design, double torque,
                                         std::string_view table, const std::string& file);

// VDI 2230 table A1: columns size, class, mu, FM_kN and MA_Nm. Nothing is fitted.
Result<Validation> validate_preload_table(std::string_view table, const std::string& file);

}  // namespace bolt::measure
