// Samples as rows of one plot: a box of the quartiles and a dot for every value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "game/plot/svg.hpp"

namespace bolt::plot {

struct StripRow {
    std::string label;
    std::vector<double> values;                  // in data units, finite
    double low = 0.0, median = 0.0, high = 0.0;  // quartiles, which the caller defines
    std::string_view style = "mpeak";            // of the dots
};

struct StripPlot {
    std::string title;  // read aloud by screen readers
    std::string unit;   // under the axis
    std::vector<StripRow> rows;
    AxisTicks ticks;
    double left = 82.0;  // px, room for the labels
};

// Dots that would overlap are stacked within the row; more than five equal values also get a text with their
// number.
std::string draw(const StripPlot& plot);

}  // namespace bolt::plot
