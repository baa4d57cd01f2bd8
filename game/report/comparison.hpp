// A comparison for the reader: on the console, as a page, as one drawing a joint.
#pragma once

#include <string>

#include "game/analysis/comparison.hpp"
#include "game/plot/plot.hpp"

namespace bolt::report {

std::string console_text(const analysis::Comparison& comparison);

// Ours and every measured cycle, shifted onto each other; 0° is the point they are aligned by.
plot::Plot overlay_plot(const analysis::Comparison& comparison, std::size_t joint);

// One joint as an SVG file of its own, with the source named in it.
std::string overlay_svg(const analysis::Comparison& comparison, std::size_t joint);

// A whole HTML document that needs nothing else.
std::string comparison_page(const analysis::Comparison& comparison);

// What one should know before trusting the figures: peaks that differ by a factor, stages without a sample.
std::vector<std::string> remarks(const analysis::Comparison& comparison);

// How the curves were laid upon each other and what the errors mean.
std::string method_text(const analysis::Comparison& comparison);

}  // namespace bolt::report
