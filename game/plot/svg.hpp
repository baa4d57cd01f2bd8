// SVG drawing: axis scales and ticks, an SVG writer, decimation of lines, and placement of labels.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bolt::plot {

struct AxisRange {
    double low = 0.0;
    double high = 1.0;
    [[nodiscard]] double span() const { return high - low; }
};

struct AxisTicks {
    std::vector<double> values;  // ascending
    int decimals = 0;            // for the labels, so that neighbouring ticks differ
    AxisRange range;             // the drawn range of the axis
};

// Returns about `count` ticks, 1, 2, 2.5 or 5 · 10ⁿ apart. The first and last one cover [low, high].
AxisTicks covering_ticks(double low, double high, int count = 5);

// Returns about `count` ticks inside the range, which stays as it is, at divisors and multiples of a turn in
// degrees (…, 15, 30, 45, 90 …).
AxisTicks degree_ticks(AxisRange range, int count = 6);

// Returns integers low … high, thinned to at most `most`; for attempts and counts.
AxisTicks count_ticks(int low, int high, int most = 12);

// In units of the drawing, x from the left and y from the top; or in the units of a plot's data.
struct SvgPoint {
    double x = 0.0;
    double y = 0.0;
};

struct SvgBox {
    double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

// Writes an SVG drawing element by element. Escapes texts, so callers must not. `style` is a list of CSS
// classes; they define the colours, so that one drawing serves light, dark and paper.
class Svg {
  public:
    // `title` is read aloud by screen readers and shown as a tooltip.
    Svg(double width, double height, std::string_view title);

    void line(SvgPoint a, SvgPoint b, std::string_view style);
    void rect(SvgBox box, std::string_view style, double radius = 0.0);
    void circle(SvgPoint centre, double radius, std::string_view style);
    // `position`: of the baseline's start, or of its middle or end with the class "mid" or "end".
    void text(SvgPoint position, std::string_view style, std::string_view text);
    void path(std::span<const SvgPoint> points, std::string_view style,
              bool closed = false);  // a NaN interrupts the path

    // Until end_clip() the drawing is clipped to `box`, and coordinates are relative to its top left corner.
    void begin_clip(SvgBox box);
    void end_clip();

    [[nodiscard]] std::string finish();  // for use inside a page, which has the style sheet

  private:
    std::string text_;
    int open_clips_ = 0;
};

// Returns the drawing as a file of its own, which contains the style sheet.
std::string standalone(std::string_view svg, std::string_view style_sheet);

// Maps a range to a length. `flip`: for y, which points upwards in plots and downwards in drawings.
struct AxisScale {
    AxisRange range;
    double length = 1.0;
    bool flip = false;
    [[nodiscard]] double operator()(double value) const {
        const double share = (value - range.low) / range.span();
        return length * (flip ? 1.0 - share : share);
    }
};

// Reduces a line to the first, lowest, highest and last point of each run of points that falls into one
// column of width `column` (the M4 rule: Jugel et al., VLDB 2014). The drawing looks the same. A NaN ends a
// run and is kept. The order is kept.
std::vector<SvgPoint> decimate(std::span<const SvgPoint> points, double column);

// Returns the points whose x is within the range, and the neighbour on either side of each stretch: the
// points that a clipped line needs.
std::vector<SvgPoint> points_within(std::span<const SvgPoint> points, AxisRange x);

// Estimate for a wide typeface, in proportion to the number of UTF-8 characters. On narrow screens the style
// sheet uses larger letters, so pass their size.
double text_width(std::string_view text, double size);

// Alignment of a text with its position: the style sheet's "mid" and "end", otherwise the start.
enum class TextAnchor { start, middle, end };

struct LabelPosition {
    SvgPoint baseline;
    TextAnchor anchor = TextAnchor::start;
};

SvgBox text_box(const LabelPosition& position, std::string_view text, double size);
std::string_view anchor_class(TextAnchor anchor);  // " mid", " end" or ""

// Sizes of the style sheet's letters on a narrow screen: small labels; all others.
inline constexpr double small_print = 12.0, large_print = 13.0;

// Places labels so that they overlap neither each other nor occupied boxes, as far as possible.
class LabelLayout {
  public:
    explicit LabelLayout(SvgBox page) : page_(page) {}

    void occupy(const SvgBox& box) { occupied_.push_back(box); }

    // Returns the index of the box with the least area outside the page or on occupied boxes, the first one
    // of equals, and occupies it.
    std::size_t place(std::span<const SvgBox> boxes);

    // Does the same for a text at one of `positions`.
    LabelPosition place(std::span<const LabelPosition> positions, std::string_view text, double size);

  private:
    [[nodiscard]] double overlap(const SvgBox& box) const;

    SvgBox page_;
    std::vector<SvgBox> occupied_;
};

}  // namespace bolt::plot
