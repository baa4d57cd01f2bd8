// Output of a comparison of virtual and measured torque: console text and HTML page.
#pragma once

#include <string>
#include <vector>

#include "game/analysis/comparison.hpp"

namespace bolt::report {

std::string console_text(const analysis::Comparison& comparison);

// A complete HTML document without external resources.
std::string comparison_page(const analysis::Comparison& comparison);

// Limits of the comparison: peaks that differ by a large factor, stages without samples.
std::vector<std::string> remarks(const analysis::Comparison& comparison);

// How the curves were aligned and how the errors are defined.
std::string method_text(const analysis::Comparison& comparison);

}  // namespace bolt::report
