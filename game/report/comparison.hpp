// Output of a comparison of virtual and measured torque: console text, HTML page, and an SVG drawing for each
// joint.
#pragma once

#include <string>

#include "game/analysis/comparison.hpp"
#include "game/plot/plot.hpp"

namespace bolt::report {

std::string console_text(const analysis::Comparison& comparison);

// The virtual curve and all measured cycles, aligned; 0° is the common point.
plot::Plot overlay_plot(const analysis::Comparison& comparison, std::size_t joint);

// One joint as a standalone SVG file that names the source.
std::string overlay_svg(const analysis::Comparison& comparison, std::size_t joint);

// A complete HTML document without external resources.
std::string comparison_page(const analysis::Comparison& comparison);

// Limits of the comparison: peaks that differ by a large factor, stages without samples.
std::vector<std::string> remarks(const analysis::Comparison& comparison);

// How the curves were aligned and how the errors are defined.
std::string method_text(const analysis::Comparison& comparison);

}  // namespace bolt::report
