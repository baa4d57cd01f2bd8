// Scales: a range, and ticks on it that a person can read.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bolt::plot {

struct Range {
    double low = 0.0;
    double high = 1.0;
    [[nodiscard]] double span() const { return high - low; }
};

struct Ticks {
    std::vector<double> at;  // rising
    int decimals = 0;        // that tell neighbouring ticks apart
    Range range;             // what the ticks, or the caller, ask to be drawn
};

// Ticks 1, 2, 2.5 or 5 · 10ⁿ apart, about `about` of them, whose first and last cover [low, high].
Ticks covering_ticks(double low, double high, int about = 5);

// Ticks inside the range, which stays as it is. Degrees step by divisors and multiples of a turn (…, 15, 30,
// 45, 90 …).
Ticks inner_ticks(Range range, int about = 6);
Ticks degree_ticks(Range range, int about = 6);

// Whole numbers low … high, thinned to at most `most`: attempts, counts.
Ticks count_ticks(int low, int high, int most = 12);

// An SVG drawing, element by element. Text is escaped here and nowhere else; colours are CSS classes, so that
// one drawing serves light, dark and paper.

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

// Fewer points for the same picture. Highest and lowest points are never lost.

// Of each run of points that falls into one column `column` wide, the first, lowest, highest and last (the M4
// rule: Jugel et al., VLDB 2014). A NaN ends a run and is kept. Order is kept.
std::vector<Point> decimate(std::span<const Point> points, double column);

// The points within [low, high] in x, and the neighbour on either side of each stretch: what a clipped line
// needs.
std::vector<Point> within(std::span<const Point> points, Range x);

// Words in a drawing, placed so that they touch neither each other nor what is drawn.

// Roughly, in a wide typeface and letter by letter of UTF-8. On narrow screens the style sheet takes larger
// letters, so ask for those.
double text_width(std::string_view words, double size);

// Where words stand for an anchor: the style sheet's "mid" and "end", else they start at it.
enum class Anchor { start, middle, end };

struct Spot {
    Point at;  // of the words' base line
    Anchor anchor = Anchor::start;
};

Box words_box(const Spot& spot, std::string_view words, double size);
std::string_view anchor_style(Anchor anchor);  // " mid", " end" or nothing

class Placer {
  public:
    explicit Placer(Box page) : page_(page) {}

    void take(const Box& box) { taken_.push_back(box); }

    // The first of the boxes that lies on the page and touches nothing taken, else the one that is least in
    // the way. It is taken then.
    std::size_t choose(std::span<const Box> boxes);

    // The same for words.
    Spot choose(std::span<const Spot> spots, std::string_view words, double size);

  private:
    [[nodiscard]] double in_the_way(const Box& box) const;

    Box page_;
    std::vector<Box> taken_;
};

}  // namespace bolt::plot
