// An SVG drawing, element by element. Text is escaped here and nowhere else; colours are CSS classes, so that
// one drawing serves light, dark and paper.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "game/plot/axis.hpp"

namespace bolt::plot {

struct Point {
    double x = 0.0;
    double y = 0.0;
};

struct Box {
    double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

// x from the left, y from the top, in the drawing's own units.
class Svg {
  public:
    // `title` is read out and shown as a tooltip.
    Svg(double width, double height, std::string_view title);

    void line(Point a, Point b, std::string_view style);
    void rect(Box box, std::string_view style, double radius = 0.0);
    void circle(Point centre, double radius, std::string_view style);
    void text(Point at, std::string_view style, std::string_view words);  // anchor by class: "mid", "end"
    void path(std::span<const Point> points, std::string_view style,
              bool closed = false);  // a NaN lifts the pen

    // What is drawn until leave() is clipped to the box; coordinates inside start at its corner.
    void enter(Box box);
    void leave();

    [[nodiscard]] std::string finish();  // for use inside a page, which brings the style sheet

  private:
    std::string text_;
    int open_ = 0;
};

// The same drawing as a file of its own, with the style sheet inside.
std::string standalone(std::string_view svg, std::string_view style_sheet);

// Maps a range to a length; `flip` for y, which grows upwards on paper.
struct Scale {
    Range range;
    double length = 1.0;
    bool flip = false;
    [[nodiscard]] double operator()(double value) const {
        const double share = (value - range.low) / range.span();
        return length * (flip ? 1.0 - share : share);
    }
};

}  // namespace bolt::plot
