#include "game/plot/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>

#include "engine/base/math.hpp"
#include "game/plot/html.hpp"

namespace bolt::plot {

namespace {

// Returns a range that ticks can divide: finite, not empty, and wide enough for distinct numbers.
AxisRange valid_range(double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return {0.0, 1.0};
    if (low > high) std::swap(low, high);
    const double least = 1e-9 * std::max({std::abs(low), std::abs(high), 1e-3});
    if (high - low < least)
        return low == 0.0 ? AxisRange{0.0, 1.0}
                          : AxisRange{low - 0.5 * std::abs(low), high + 0.5 * std::abs(high)};
    return {low, high};
}

double decimal_step(double span, int count) {
    const double rough = span / std::max(1, count);
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 2.5, 5.0})
        if (rough <= factor * decade * 1.0000001) return factor * decade;
    return 10.0 * decade;
}

double degree_step(double span, int count) {
    const double rough = span / std::max(1, count);
    if (rough < 1.0) return decimal_step(span, count);
    for (const double step : {1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 90.0, 180.0, 360.0})
        if (rough <= step) return step;
    return 360.0 * std::ceil(rough / 360.0);
}

int decimals_of(double step) {
    int decimals = 0;
    for (double scaled = step; decimals < 12 && std::abs(scaled - std::round(scaled)) > 1e-6 * scaled;
         scaled *= 10.0)
        ++decimals;
    return decimals;
}

AxisTicks ticks_between(AxisRange range, double first, double last, double step) {
    AxisTicks ticks;
    ticks.range = range;
    ticks.decimals = decimals_of(step);
    for (double k = first; k <= last + 0.5; k += 1.0) ticks.values.push_back(k * step);
    return ticks;
}

AxisTicks inside(AxisRange range, double step) {
    constexpr double slack = 1e-9;  // a tick on the border is drawn
    return ticks_between(range, std::ceil(range.low / step - slack), std::floor(range.high / step + slack),
                         step);
}

}  // namespace

AxisTicks covering_ticks(double low, double high, int count) {
    const AxisRange range = valid_range(low, high);
    const double step = decimal_step(range.span(), count);
    const double first = std::floor(range.low / step + 1e-9);
    const double last = std::ceil(range.high / step - 1e-9);
    return ticks_between({first * step, last * step}, first, last, step);
}

AxisTicks degree_ticks(AxisRange range, int count) {
    const AxisRange r = valid_range(range.low, range.high);
    return inside(r, degree_step(r.span(), count));
}

AxisTicks count_ticks(int low, int high, int most) {
    const int count = std::max(1, high - low + 1);
    const int step = (count + std::max(1, most) - 1) / std::max(1, most);
    AxisTicks ticks;
    ticks.range = {low - 0.5, std::max(low, high) + 0.5};
    for (int i = low; i <= std::max(low, high); i += step) ticks.values.push_back(i);
    return ticks;
}

namespace {

// Two decimals without trailing zeros; the unit is about a pixel. Clamped far outside the drawing, where
// renderers lose precision.
std::string coordinate(double value) {
    if (!std::isfinite(value)) value = 0.0;
    std::string text = fmt::format("{:.2f}", std::clamp(value, -1e5, 1e5));
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

}  // namespace

Svg::Svg(double width, double height, std::string_view title) {
    fmt::format_to(std::back_inserter(text_),
                   R"(<svg viewBox="0 0 {} {}" role="img" xmlns="http://www.w3.org/2000/svg">)",
                   coordinate(width), coordinate(height));
    fmt::format_to(std::back_inserter(text_), "<title>{}</title>", escape(title));
}

void Svg::line(SvgPoint a, SvgPoint b, std::string_view style) {
    fmt::format_to(std::back_inserter(text_), R"(<line x1="{}" y1="{}" x2="{}" y2="{}" class="{}"/>)",
                   coordinate(a.x), coordinate(a.y), coordinate(b.x), coordinate(b.y), escape(style));
}

void Svg::rect(SvgBox box, std::string_view style, double radius) {
    fmt::format_to(std::back_inserter(text_), R"(<rect x="{}" y="{}" width="{}" height="{}")",
                   coordinate(box.x), coordinate(box.y), coordinate(std::max(0.0, box.width)),
                   coordinate(std::max(0.0, box.height)));
    if (radius > 0.0) fmt::format_to(std::back_inserter(text_), R"( rx="{}")", coordinate(radius));
    fmt::format_to(std::back_inserter(text_), R"( class="{}"/>)", escape(style));
}

void Svg::circle(SvgPoint centre, double radius, std::string_view style) {
    fmt::format_to(std::back_inserter(text_), R"(<circle cx="{}" cy="{}" r="{}" class="{}"/>)",
                   coordinate(centre.x), coordinate(centre.y), coordinate(radius), escape(style));
}

void Svg::text(SvgPoint position, std::string_view style, std::string_view text) {
    fmt::format_to(std::back_inserter(text_), R"(<text x="{}" y="{}" class="{}">{}</text>)",
                   coordinate(position.x), coordinate(position.y), escape(style), escape(text));
}

void Svg::path(std::span<const SvgPoint> points, std::string_view style, bool closed) {
    std::string data;
    bool pen_down = false;
    for (const SvgPoint& p : points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
            pen_down = false;
            continue;
        }
        fmt::format_to(std::back_inserter(data), "{}{} {}", pen_down ? "L" : "M", coordinate(p.x),
                       coordinate(p.y));
        pen_down = true;
    }
    if (data.empty()) return;
    if (closed) data += "Z";
    fmt::format_to(std::back_inserter(text_), R"(<path d="{}" class="{}"/>)", data, escape(style));
}

void Svg::begin_clip(SvgBox box) {
    fmt::format_to(std::back_inserter(text_), R"(<svg x="{}" y="{}" width="{}" height="{}">)",
                   coordinate(box.x), coordinate(box.y), coordinate(box.width), coordinate(box.height));
    ++open_clips_;
}

void Svg::end_clip() {
    if (open_clips_ == 0) return;
    text_ += "</svg>";
    --open_clips_;
}

std::string Svg::finish() {
    while (open_clips_ > 0) end_clip();
    return text_ + "</svg>\n";
}

std::string standalone(std::string_view svg, std::string_view style_sheet) {
    const std::size_t after_title = svg.find("</title>");
    const std::size_t at = after_title == std::string_view::npos ? svg.find('>') + 1 : after_title + 8;
    // A style sheet may contain '>' and '&', hence CDATA.
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}<style><![CDATA[{}]]></style>{}",
                       svg.substr(0, at), style_sheet, svg.substr(at));
}

namespace {

bool is_gap(const SvgPoint& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); }

void append_run(std::vector<SvgPoint>& out, std::span<const SvgPoint> run) {
    const auto by_y = [](const SvgPoint& a, const SvgPoint& b) { return a.y < b.y; };
    const auto [low, high] = std::minmax_element(run.begin(), run.end(), by_y);
    std::ptrdiff_t keep[] = {0, low - run.begin(), high - run.begin(), std::ssize(run) - 1};
    std::sort(std::begin(keep), std::end(keep));
    std::ptrdiff_t last = -1;
    for (const std::ptrdiff_t i : keep) {
        if (i != last) out.push_back(run[static_cast<std::size_t>(i)]);
        last = i;
    }
}

}  // namespace

std::vector<SvgPoint> decimate(std::span<const SvgPoint> points, double column) {
    std::vector<SvgPoint> out;
    for (std::size_t begin = 0; begin < points.size();) {
        if (is_gap(points[begin]) || !(column > 0.0)) {
            out.push_back(points[begin++]);
            continue;
        }
        const double cell = std::floor(points[begin].x / column);
        std::size_t end = begin + 1;
        while (end < points.size() && !is_gap(points[end]) && std::floor(points[end].x / column) == cell)
            ++end;
        append_run(out, points.subspan(begin, end - begin));
        begin = end;
    }
    return out;
}

std::vector<SvgPoint> points_within(std::span<const SvgPoint> points, AxisRange x) {
    std::vector<SvgPoint> out;
    bool drawing = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SvgPoint& p = points[i];
        const bool gap = is_gap(p);
        const bool inside = !gap && p.x >= x.low && p.x <= x.high;
        if (inside && !drawing && i > 0 && !is_gap(points[i - 1])) out.push_back(points[i - 1]);
        if (inside || drawing) out.push_back(p);
        if (drawing && !inside && !gap) out.push_back({nan, nan});
        drawing = inside;
    }
    return out;
}

namespace {

double overlap_length(double a, double a_size, double b, double b_size) {
    return std::max(0.0, std::min(a + a_size, b + b_size) - std::max(a, b));
}

double overlap_area(const SvgBox& a, const SvgBox& b) {
    return overlap_length(a.x, a.width, b.x, b.width) * overlap_length(a.y, a.height, b.y, b.height);
}

}  // namespace

double text_width(std::string_view text, double size) {
    const auto starts_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    return 0.58 * size * static_cast<double>(std::count_if(text.begin(), text.end(), starts_character));
}

SvgBox text_box(const LabelPosition& position, std::string_view text, double size) {
    const double width = text_width(text, size);
    const double share = position.anchor == TextAnchor::start    ? 0.0
                         : position.anchor == TextAnchor::middle ? 0.5
                                                                 : 1.0;
    return {position.baseline.x - share * width, position.baseline.y - 0.8 * size, width, size};
}

std::string_view anchor_class(TextAnchor anchor) {
    return anchor == TextAnchor::start ? "" : anchor == TextAnchor::middle ? " mid" : " end";
}

double LabelLayout::overlap(const SvgBox& box) const {
    double area = box.width * box.height - overlap_area(box, page_);
    for (const SvgBox& other : occupied_) area += overlap_area(box, other);
    return area;
}

std::size_t LabelLayout::place(std::span<const SvgBox> boxes) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < boxes.size(); ++i)
        if (overlap(boxes[i]) < overlap(boxes[best]) - 1e-6) best = i;
    if (!boxes.empty()) occupy(boxes[best]);
    return best;
}

LabelPosition LabelLayout::place(std::span<const LabelPosition> positions, std::string_view text,
                                 double size) {
    std::vector<SvgBox> boxes;
    for (const LabelPosition& position : positions) boxes.push_back(text_box(position, text, size));
    return positions.empty() ? LabelPosition{} : positions[place(boxes)];
}

}  // namespace bolt::plot
