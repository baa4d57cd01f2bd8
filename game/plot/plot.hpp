// An x–y plot, described as data and drawn in one call. A style is the name of a CSS class
// (game/plot/html.cpp).
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "game/plot/svg.hpp"

namespace bolt::plot {

struct PlotAxis {
    AxisTicks ticks;
    std::string label;
};

struct PlotLine {
    std::vector<SvgPoint> points;  // in data units; a NaN interrupts the line
    std::string_view style;
    bool second_axis = false;
};

// An interval of x (over the full height) or of y (over the full width).
struct PlotBand {
    AxisRange range;
    std::string_view style;
    std::string label;   // narrow bands of the same label share one text
    bool of_y = false;   // `range` is of y
    bool strip = false;  // of x: only a strip along the axis, which hides no curve
};

// A thin line at one value of x or y.
struct ReferenceLine {
    double value = 0.0;
    std::string_view style;
    std::string label;
    bool of_y = false;  // `value` is of y
};

enum class MarkerShape { dot, ring, square, triangle };

struct Marker {
    SvgPoint position;  // in data units
    MarkerShape shape = MarkerShape::dot;
    std::string_view style;
    std::string label;
    bool second_axis = false;
    bool small_label = false;  // small, preferably to the lower right; otherwise bold, preferably above
};

struct Plot {
    double width = 480.0, height = 300.0;
    std::string title;
    PlotAxis x, y;
    std::optional<PlotAxis> y2;
    std::vector<PlotBand> bands;  // drawn in this order, below everything else
    std::vector<ReferenceLine> reference_lines;
    std::vector<PlotLine> lines;
    std::vector<Marker> markers;
};

// The area of the curves, between the axes.
SvgBox plot_area(const Plot& plot);

// Draws into `svg`, which must have the plot's size.
void draw_into(Svg& svg, const Plot& plot);
std::string draw(const Plot& plot);

}  // namespace bolt::plot
