#include "game/plot/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "game/plot/text.hpp"

namespace bolt::plot {

namespace {

// Two decimals of a unit that is about a pixel, without trailing zeros; far outside the drawing it is cut
// off, as renderers lose precision there.
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

void Svg::line(Point a, Point b, std::string_view style) {
    fmt::format_to(std::back_inserter(text_), R"(<line x1="{}" y1="{}" x2="{}" y2="{}" class="{}"/>)",
                   coordinate(a.x), coordinate(a.y), coordinate(b.x), coordinate(b.y), escape(style));
}

void Svg::rect(Box box, std::string_view style, double radius) {
    fmt::format_to(std::back_inserter(text_), R"(<rect x="{}" y="{}" width="{}" height="{}")",
                   coordinate(box.x), coordinate(box.y), coordinate(std::max(0.0, box.width)),
                   coordinate(std::max(0.0, box.height)));
    if (radius > 0.0) fmt::format_to(std::back_inserter(text_), R"( rx="{}")", coordinate(radius));
    fmt::format_to(std::back_inserter(text_), R"( class="{}"/>)", escape(style));
}

void Svg::circle(Point centre, double radius, std::string_view style) {
    fmt::format_to(std::back_inserter(text_), R"(<circle cx="{}" cy="{}" r="{}" class="{}"/>)",
                   coordinate(centre.x), coordinate(centre.y), coordinate(radius), escape(style));
}

void Svg::text(Point at, std::string_view style, std::string_view words) {
    fmt::format_to(std::back_inserter(text_), R"(<text x="{}" y="{}" class="{}">{}</text>)", coordinate(at.x),
                   coordinate(at.y), escape(style), escape(words));
}

void Svg::path(std::span<const Point> points, std::string_view style, bool closed) {
    std::string data;
    bool down = false;
    for (const Point& p : points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
            down = false;
            continue;
        }
        fmt::format_to(std::back_inserter(data), "{}{} {}", down ? "L" : "M", coordinate(p.x),
                       coordinate(p.y));
        down = true;
    }
    if (data.empty()) return;
    if (closed) data += "Z";
    fmt::format_to(std::back_inserter(text_), R"(<path d="{}" class="{}"/>)", data, escape(style));
}

void Svg::enter(Box box) {
    fmt::format_to(std::back_inserter(text_), R"(<svg x="{}" y="{}" width="{}" height="{}">)",
                   coordinate(box.x), coordinate(box.y), coordinate(box.width), coordinate(box.height));
    ++open_;
}

void Svg::leave() {
    if (open_ == 0) return;
    text_ += "</svg>";
    --open_;
}

std::string Svg::finish() {
    while (open_ > 0) leave();
    return text_ + "</svg>\n";
}

std::string standalone(std::string_view svg, std::string_view style_sheet) {
    const std::size_t after_title = svg.find("</title>");
    const std::size_t at = after_title == std::string_view::npos ? svg.find('>') + 1 : after_title + 8;
    // In CDATA, as a style sheet may hold '>' and '&'.
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}<style><![CDATA[{}]]></style>{}",
                       svg.substr(0, at), style_sheet, svg.substr(at));
}

}  // namespace bolt::plot
