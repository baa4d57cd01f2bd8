#include "game/plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"

namespace bolt::plot {

namespace {

constexpr double label_height =
    20.0;  // px above the area: baseline of the axis labels and of the second row of band labels

struct Mapping {
    AxisScale x, y, y2;
    [[nodiscard]] SvgPoint operator()(SvgPoint p, bool second) const {
        return {x(p.x), second ? y2(p.y) : y(p.y)};
    }
};

Mapping mapping_of(const Plot& plot, const SvgBox& area) {
    Mapping map{{plot.x.ticks.range, area.width, false}, {plot.y.ticks.range, area.height, true}, {}};
    map.y2 = plot.y2 ? AxisScale{plot.y2->ticks.range, area.height, true} : map.y;
    return map;
}

bool has_band_labels(const Plot& plot) {
    return std::any_of(plot.bands.begin(), plot.bands.end(),
                       [](const PlotBand& b) { return !b.of_y && !b.label.empty(); });
}

void draw_band(Svg& svg, const PlotBand& band, const Mapping& map, const SvgBox& area) {
    const AxisScale& scale = band.of_y ? map.y : map.x;
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

struct BandLabel {
    const PlotBand* band = nullptr;
    double from = 0.0, to = 0.0;  // x of the band within the area
    double start = 0.0;           // x of the text's start
    [[nodiscard]] double width() const { return text_width(band->label, small_print); }
    [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

// Returns the labels that do not fit into any band of that label, each for the widest of its bands, sorted by
// x.
std::vector<BandLabel> narrow_labels(const std::vector<BandLabel>& all) {
    std::vector<BandLabel> narrow;
    for (const BandLabel& label : all) {
        const auto same = [&](const BandLabel& other) { return other.band->label == label.band->label; };
        const auto fits = [&](const BandLabel& o) { return same(o) && o.width() <= o.to - o.from; };
        if (std::any_of(all.begin(), all.end(), fits)) continue;
        const auto found = std::find_if(narrow.begin(), narrow.end(), same);
        if (found == narrow.end())
            narrow.push_back(label);
        else if (label.to - label.from > found->to - found->from)
            *found = label;
    }
    std::sort(narrow.begin(), narrow.end(),
              [](const BandLabel& a, const BandLabel& b) { return a.middle() < b.middle(); });
    return narrow;
}

// Places the labels side by side within `room`, each as close to its band as the others permit.
void distribute(std::vector<BandLabel>& labels, AxisRange room) {
    constexpr double gap = 6.0;
    double free = room.low;
    for (BandLabel& label : labels) {
        label.start = std::max(free, label.middle() - 0.5 * label.width());
        free = label.start + label.width() + gap;
    }
    double end = room.high;
    for (auto label = labels.rbegin(); label != labels.rend(); ++label) {
        label->start = std::min(label->start, end - label->width());
        end = label->start - gap;
    }
}

// Draws the labels above the area: over the band if the label fits, otherwise in a second row with a line to
// the band.
void draw_band_labels(Svg& svg, const Plot& plot, const Mapping& map, const SvgBox& area) {
    std::vector<BandLabel> all;
    for (const PlotBand& band : plot.bands) {
        const double from = std::clamp(map.x(band.range.low), 0.0, area.width);
        const double to = std::clamp(map.x(band.range.high), 0.0, area.width);
        if (!band.of_y && !band.label.empty() && to > from) all.push_back({&band, from, to, from + 1.0});
    }
    for (const BandLabel& label : all)
        if (label.width() <= label.to - label.from)
            svg.text({area.x + label.start, area.y - 5.0}, "st", label.band->label);
    std::vector<BandLabel> narrow = narrow_labels(all);
    const double left = text_width(plot.y.label, large_print) - 34.0 + 6.0;
    const double right = plot.y2 ? text_width(plot.y2->label, large_print) - 32.0 + 6.0 : 0.0;
    distribute(narrow, {left, area.width - right});
    for (const BandLabel& label : narrow) {
        if (label.start < left - 0.5) continue;  // no room
        const double foot = std::clamp(label.middle(), label.start + 3.0, label.start + label.width() - 6.0);
        // Vertical through the first row, then sideways to the label.
        const SvgPoint bend{area.x + label.middle(), area.y - 15.0};
        svg.line({bend.x, area.y}, bend, "ld");
        svg.line(bend, {area.x + foot, area.y - label_height + 3.0}, "ld");
        svg.text({area.x + label.start, area.y - label_height}, "st", label.band->label);
    }
}

void draw_reference_line(Svg& svg, const ReferenceLine& line, const Mapping& map, const SvgBox& area) {
    const double at = line.of_y ? map.y(line.value) : map.x(line.value);
    if (!(at >= -0.5 && at <= (line.of_y ? area.height : area.width) + 0.5)) return;
    if (line.of_y)
        svg.line({0.0, at}, {area.width, at}, line.style);
    else
        svg.line({at, 0.0}, {at, area.height}, line.style);
    if (line.label.empty()) return;
    if (line.of_y)
        svg.text({4.0, at - 4.0}, "sm", line.label);
    else
        svg.text({at + 4.0, area.height - 5.0}, "sm", line.label);
}

void draw_line(Svg& svg, const PlotLine& line, const Mapping& map) {
    std::vector<SvgPoint> points = points_within(line.points, map.x.range);
    for (SvgPoint& p : points) p = map(p, line.second_axis);
    svg.path(decimate(points, 1.0), line.style);
}

// Returns the marker's position in the drawing; none outside the area.
std::optional<SvgPoint> drawn_position(const Marker& marker, const Mapping& map, const SvgBox& area) {
    const SvgPoint in = map(marker.position, marker.second_axis);
    // A marker on the border is drawn.
    const auto outside = [](double v, double size) { return !(v >= -0.5 && v <= size + 0.5); };
    if (outside(in.x, area.width) || outside(in.y, area.height)) return std::nullopt;
    return SvgPoint{area.x + in.x, area.y + in.y};
}

constexpr double marker_radius = 3.2;

void draw_marker(Svg& svg, const Marker& marker, SvgPoint p) {
    constexpr double r = marker_radius;
    switch (marker.shape) {
        case MarkerShape::dot:
        case MarkerShape::ring:
            svg.circle(p, r, marker.style);
            break;
        case MarkerShape::square:
            svg.rect({p.x - r, p.y - r, 2.0 * r, 2.0 * r}, marker.style);
            break;
        case MarkerShape::triangle: {
            const SvgPoint corners[] = {{p.x - r - 1.0, p.y - r}, {p.x + r + 1.0, p.y - r}, {p.x, p.y + r}};
            svg.path(corners, marker.style, true);
            break;
        }
    }
}

void draw_marker_label(Svg& svg, const Marker& marker, SvgPoint p, const SvgBox& area, LabelLayout& labels) {
    const LabelPosition above_left{{p.x - 6.0, p.y - 6.0}, TextAnchor::end},
        above_right{{p.x + 6.0, p.y - 6.0}};
    const LabelPosition below_left{{p.x - 8.0, p.y + 13.0}, TextAnchor::end},
        below_right{{p.x + 8.0, p.y + 11.0}};
    const LabelPosition far_below{{p.x - 8.0, p.y + 26.0}, TextAnchor::end},
        far_above{{p.x - 8.0, p.y - 20.0}, TextAnchor::end};
    const LabelPosition farther_below{{p.x - 8.0, p.y + 39.0}, TextAnchor::end};
    const LabelPosition farther_above{{p.x - 8.0, p.y - 33.0}, TextAnchor::end};
    if (marker.small_label) {
        // The labels of passes stay next to their squares, even if they overlap other elements.
        std::vector<LabelPosition> positions = {below_right, above_left, below_left, above_right};
        if (!marker.second_axis)
            positions.insert(positions.end(), {far_above, farther_above, far_below, farther_below});
        const LabelPosition position = labels.place(positions, marker.label, small_print);
        svg.text(position.baseline, fmt::format("sm{}", anchor_class(position.anchor)), marker.label);
        return;
    }
    const bool left = p.x - area.x > 0.5 * area.width;
    const LabelPosition positions[] = {left ? above_left : above_right,
                                       left ? above_right : above_left,
                                       left ? below_left : below_right,
                                       left ? below_right : below_left,
                                       far_above,
                                       far_below};
    const LabelPosition position = labels.place(positions, marker.label, large_print);
    svg.text(position.baseline, fmt::format("mk{}", anchor_class(position.anchor)), marker.label);
}

// Draws all markers before the labels, so that labels can avoid them; bold labels are placed first.
void draw_markers(Svg& svg, const Plot& plot, const Mapping& map, const SvgBox& area) {
    LabelLayout labels(area);
    for (const PlotLine& line : plot.lines)
        for (SvgPoint p : points_within(line.points, map.x.range)) {
            p = map(p, line.second_axis);
            if (std::isfinite(p.x) && std::isfinite(p.y))
                labels.occupy({area.x + p.x - 0.5, area.y + p.y - 0.5, 1.0, 1.0});
        }
    for (const Marker& marker : plot.markers) {
        const std::optional<SvgPoint> p = drawn_position(marker, map, area);
        if (!p) continue;
        draw_marker(svg, marker, *p);
        labels.occupy({p->x - marker_radius, p->y - marker_radius, 2.0 * marker_radius, 2.0 * marker_radius});
    }
    for (const bool small : {false, true})
        for (const Marker& marker : plot.markers) {
            const std::optional<SvgPoint> p = drawn_position(marker, map, area);
            if (p && marker.small_label == small && !marker.label.empty())
                draw_marker_label(svg, marker, *p, area, labels);
        }
}

void draw_grid(Svg& svg, const Plot& plot, const Mapping& map, const SvgBox& area) {
    for (const double at : plot.y.ticks.values) svg.line({0.0, map.y(at)}, {area.width, map.y(at)}, "gr");
}

void draw_axes(Svg& svg, const Plot& plot, const Mapping& map, const SvgBox& area) {
    const double head = has_band_labels(plot) ? label_height : 9.0;
    const double right = area.x + area.width, bottom = area.y + area.height;
    svg.line({area.x, bottom}, {right, bottom}, "ax");
    for (const double at : plot.x.ticks.values) {
        const double x = area.x + map.x(at);
        svg.line({x, bottom}, {x, bottom + 4.0}, "ax");
        svg.text({x, bottom + 16.0}, "tk mid", number(at, plot.x.ticks.decimals));
    }
    for (const double at : plot.y.ticks.values)
        svg.text({area.x - 6.0, area.y + map.y(at) + 4.0}, "tk end", number(at, plot.y.ticks.decimals));
    svg.text({area.x - 34.0, area.y - head}, "lb", plot.y.label);
    svg.text({area.x + 0.5 * area.width, bottom + 32.0}, "lb mid", plot.x.label);
    if (!plot.y2) return;
    for (const double at : plot.y2->ticks.values)
        svg.text({right + 6.0, area.y + map.y2(at) + 4.0}, "tk", number(at, plot.y2->ticks.decimals));
    svg.text({right + 32.0, area.y - head}, "lb end", plot.y2->label);
}

}  // namespace

SvgBox plot_area(const Plot& plot) {
    constexpr double left = 42.0, bottom = 40.0;
    const double top = has_band_labels(plot) ? 35.0 : 24.0;
    const double right = plot.y2 ? 40.0 : 12.0;
    return {left, top, std::max(1.0, plot.width - left - right), std::max(1.0, plot.height - top - bottom)};
}

void draw_into(Svg& svg, const Plot& plot) {
    const SvgBox area = plot_area(plot);
    const Mapping map = mapping_of(plot, area);
    svg.begin_clip(area);
    for (const PlotBand& band : plot.bands) draw_band(svg, band, map, area);
    draw_grid(svg, plot, map, area);
    for (const ReferenceLine& line : plot.reference_lines) draw_reference_line(svg, line, map, area);
    for (const PlotLine& line : plot.lines) draw_line(svg, line, map);
    svg.end_clip();
    draw_band_labels(svg, plot, map, area);
    draw_axes(svg, plot, map, area);
    draw_markers(svg, plot, map, area);
}

std::string draw(const Plot& plot) {
    Svg svg(plot.width, plot.height, plot.title);
    draw_into(svg, plot);
    return svg.finish();
}

}  // namespace bolt::plot
