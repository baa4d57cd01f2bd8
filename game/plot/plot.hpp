// An x–y plot, stated as data and drawn in one go.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "game/plot/svg.hpp"

namespace bolt::plot {

// Styles are names of CSS classes (game/plot/html.cpp).
struct Axis {
    Ticks ticks;
    std::string label;
};

struct Line {
    std::vector<Point> points;  // a NaN breaks the line
    std::string_view style;
    bool second_axis = false;
};

// A stretch of x (over the full height) or of y (over the full width).
struct Band {
    Range range;
    std::string_view style;
    std::string label;  // bands of the same name that are too narrow for it share one
    bool of_y = false;
    bool strip = false;  // of x: only along the axis, so that it hides nothing
};

// A thin line at one x or y.
struct Rule {
    double at = 0.0;
    std::string_view style;
    std::string label;
    bool of_y = false;
};

enum class Shape { dot, ring, square, triangle };

struct Mark {
    Point at;
    Shape shape = Shape::dot;
    std::string_view style;
    std::string label;
    bool second_axis = false;
    bool quiet = false;  // small print to the lower right; else bold, above; elsewhere where that is taken
};

struct Plot {
    double width = 480.0, height = 300.0;
    std::string title;
    Axis x, y;
    std::optional<Axis> y2;
    std::vector<Band> bands;  // first drawn lies lowest
    std::vector<Rule> rules;
    std::vector<Line> lines;
    std::vector<Mark> marks;
};

// Where the axes enclose the curves.
Box plot_area(const Plot& plot);

// Draws into `svg`, whose size is the plot's.
void draw_into(Svg& svg, const Plot& plot);
std::string draw(const Plot& plot);

}  // namespace bolt::plot
