#include "game/report/plot.hpp"

#include <algorithm>
#include <cmath>

#include "game/report/decimate.hpp"
#include "game/report/text.hpp"

namespace bolt::report {

namespace {

constexpr double letter = 5.8;  // width of a letter of the small print, in a wide typeface

struct Mapping {
    Scale x, y, y2;
    [[nodiscard]] Point operator()(Point p, bool second) const { return {x(p.x), second ? y2(p.y) : y(p.y)}; }
};

Mapping mapping_of(const Plot& plot, const Box& area) {
    Mapping map{{plot.x.ticks.range, area.width, false}, {plot.y.ticks.range, area.height, true}, {}};
    map.y2 = plot.y2 ? Scale{plot.y2->ticks.range, area.height, true} : map.y;
    return map;
}

bool has_band_labels(const Plot& plot) {
    return std::any_of(plot.bands.begin(), plot.bands.end(), [](const Band& b) { return !b.label.empty(); });
}

// Letters of a UTF-8 text, roughly: what does not continue a sequence.
double width_of(std::string_view text) {
    const auto starts = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; };
    return letter * static_cast<double>(std::count_if(text.begin(), text.end(), starts));
}

void draw_band(Svg& svg, const Band& band, const Mapping& map, const Box& area) {
    const Scale& scale = band.of_y ? map.y : map.x;
    const double a = std::clamp(scale(band.range.low), 0.0, scale.length);
    const double b = std::clamp(scale(band.range.high), 0.0, scale.length);
    const double from = std::min(a, b), size = std::abs(b - a);
    if (band.of_y) {
        svg.rect({0.0, from, area.width, std::max(size, 0.75)}, band.style);
        return;
    }
    constexpr double strip = 5.0;
    svg.rect({from, band.strip ? area.height - strip : 0.0, size, band.strip ? strip : area.height},
             band.style);
}

// Above the area, where no curve runs.
void draw_band_label(Svg& svg, const Band& band, const Mapping& map, const Box& area) {
    const double from = std::clamp(map.x(band.range.low), 0.0, area.width);
    const double to = std::clamp(map.x(band.range.high), 0.0, area.width);
    if (band.of_y || band.label.empty() || width_of(band.label) > to - from) return;
    svg.text({area.x + from + 1.0, area.y - 5.0}, "st", band.label);
}

void draw_rule(Svg& svg, const Rule& rule, const Mapping& map, const Box& area) {
    const double at = rule.of_y ? map.y(rule.at) : map.x(rule.at);
    if (!(at >= -0.5 && at <= (rule.of_y ? area.height : area.width) + 0.5)) return;
    if (rule.of_y)
        svg.line({0.0, at}, {area.width, at}, rule.style);
    else
        svg.line({at, 0.0}, {at, area.height}, rule.style);
    if (rule.label.empty()) return;
    if (rule.of_y)
        svg.text({4.0, at - 4.0}, "sm", rule.label);
    else
        svg.text({at + 4.0, area.height - 5.0}, "sm", rule.label);
}

void draw_line(Svg& svg, const Line& line, const Mapping& map) {
    std::vector<Point> points = within(line.points, map.x.range);
    for (Point& p : points) p = map(p, line.second_axis);
    svg.path(decimate(points, 1.0), line.style);
}

void draw_mark(Svg& svg, const Mark& mark, const Mapping& map, const Box& area) {
    const Point in = map(mark.at, mark.second_axis);  // within the area, but drawn whole on its border
    const auto outside = [](double v, double size) { return !(v >= -0.5 && v <= size + 0.5); };
    if (outside(in.x, area.width) || outside(in.y, area.height)) return;
    const Point p{area.x + in.x, area.y + in.y};
    const double right = area.x + area.width, bottom = area.y + area.height;
    constexpr double r = 3.2;
    switch (mark.shape) {
        case Shape::dot:
        case Shape::ring:
            svg.circle(p, r, mark.style);
            break;
        case Shape::square:
            svg.rect({p.x - r, p.y - r, 2.0 * r, 2.0 * r}, mark.style);
            break;
        case Shape::triangle: {
            const Point corners[] = {{p.x - r - 1.0, p.y - r}, {p.x + r + 1.0, p.y - r}, {p.x, p.y + r}};
            svg.path(corners, mark.style, true);
            break;
        }
    }
    if (mark.label.empty()) return;
    if (mark.quiet) {
        const bool fits = p.x + 8.0 + width_of(mark.label) < right;
        const double low = std::min(p.y + 9.0, bottom - 4.0);
        svg.text({fits ? p.x + 8.0 : p.x - 7.0, fits ? low : p.y - 6.0}, fits ? "sm" : "sm end", mark.label);
        return;
    }
    const bool left = in.x > 0.5 * area.width;
    const double y = std::max(p.y - 6.0, area.y + 10.0);
    svg.text({left ? p.x - 6.0 : p.x + 6.0, y}, left ? "mk end" : "mk", mark.label);
}

void draw_grid(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    for (const double at : plot.y.ticks.at) svg.line({0.0, map.y(at)}, {area.width, map.y(at)}, "gr");
}

void draw_axes(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    const double head = has_band_labels(plot) ? 20.0 : 9.0;
    const double right = area.x + area.width, bottom = area.y + area.height;
    svg.line({area.x, bottom}, {right, bottom}, "ax");
    for (const double at : plot.x.ticks.at) {
        const double x = area.x + map.x(at);
        svg.line({x, bottom}, {x, bottom + 4.0}, "ax");
        svg.text({x, bottom + 16.0}, "tk mid", number(at, plot.x.ticks.decimals));
    }
    for (const double at : plot.y.ticks.at)
        svg.text({area.x - 6.0, area.y + map.y(at) + 4.0}, "tk end", number(at, plot.y.ticks.decimals));
    svg.text({area.x - 34.0, area.y - head}, "lb", plot.y.label);
    svg.text({area.x + 0.5 * area.width, bottom + 32.0}, "lb mid", plot.x.label);
    if (!plot.y2) return;
    for (const double at : plot.y2->ticks.at)
        svg.text({right + 6.0, area.y + map.y2(at) + 4.0}, "tk", number(at, plot.y2->ticks.decimals));
    svg.text({right + 32.0, area.y - head}, "lb end", plot.y2->label);
}

}  // namespace

Box plot_area(const Plot& plot) {
    constexpr double left = 42.0, bottom = 40.0;
    const double top = has_band_labels(plot) ? 35.0 : 24.0;
    const double right = plot.y2 ? 40.0 : 12.0;
    return {left, top, std::max(1.0, plot.width - left - right), std::max(1.0, plot.height - top - bottom)};
}

void draw_into(Svg& svg, const Plot& plot) {
    const Box area = plot_area(plot);
    const Mapping map = mapping_of(plot, area);
    svg.enter(area);
    for (const Band& band : plot.bands) draw_band(svg, band, map, area);
    draw_grid(svg, plot, map, area);
    for (const Rule& rule : plot.rules) draw_rule(svg, rule, map, area);
    for (const Line& line : plot.lines) draw_line(svg, line, map);
    svg.leave();
    for (const Band& band : plot.bands) draw_band_label(svg, band, map, area);
    draw_axes(svg, plot, map, area);
    for (const Mark& mark : plot.marks) draw_mark(svg, mark, map, area);
}

std::string draw(const Plot& plot) {
    Svg svg(plot.width, plot.height, plot.title);
    draw_into(svg, plot);
    return svg.finish();
}

}  // namespace bolt::report
