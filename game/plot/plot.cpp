#include "game/plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/html.hpp"
#include "game/plot/svg.hpp"

namespace bolt::plot {

namespace {

constexpr double small_print = 12.0;  // letters on a narrow screen
constexpr double large_print = 13.0;
constexpr double head_high = 20.0;  // base line above the area: names of the axes, second row of the bands

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
    return std::any_of(plot.bands.begin(), plot.bands.end(),
                       [](const Band& b) { return !b.of_y && !b.label.empty(); });
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

struct BandName {
    const Band* band = nullptr;
    double from = 0.0, to = 0.0;  // of the band, within the area
    double at = 0.0;              // where the name starts
    [[nodiscard]] double width() const { return text_width(band->label, small_print); }
    [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

// Bands too narrow for their name, one of each name that stands nowhere else: the widest.
std::vector<BandName> unnamed(const std::vector<BandName>& all) {
    std::vector<BandName> narrow;
    for (const BandName& name : all) {
        const auto same = [&](const BandName& other) { return other.band->label == name.band->label; };
        const auto fits = [&](const BandName& o) { return same(o) && o.width() <= o.to - o.from; };
        if (std::any_of(all.begin(), all.end(), fits)) continue;
        const auto found = std::find_if(narrow.begin(), narrow.end(), same);
        if (found == narrow.end())
            narrow.push_back(name);
        else if (name.to - name.from > found->to - found->from)
            *found = name;
    }
    std::sort(narrow.begin(), narrow.end(),
              [](const BandName& a, const BandName& b) { return a.middle() < b.middle(); });
    return narrow;
}

// Side by side between the names of the axes, each as near to its band as the others let it.
void spread(std::vector<BandName>& names, Range room) {
    constexpr double gap = 6.0;
    double free = room.low;
    for (BandName& name : names) {
        name.at = std::max(free, name.middle() - 0.5 * name.width());
        free = name.at + name.width() + gap;
    }
    double end = room.high;
    for (auto name = names.rbegin(); name != names.rend(); ++name) {
        name->at = std::min(name->at, end - name->width());
        end = name->at - gap;
    }
}

// Above the area, where no curve runs: over its band where it fits, else in a second row with a line to the
// band.
void draw_band_names(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    std::vector<BandName> all;
    for (const Band& band : plot.bands) {
        const double from = std::clamp(map.x(band.range.low), 0.0, area.width);
        const double to = std::clamp(map.x(band.range.high), 0.0, area.width);
        if (!band.of_y && !band.label.empty() && to > from) all.push_back({&band, from, to, from + 1.0});
    }
    for (const BandName& name : all)
        if (name.width() <= name.to - name.from)
            svg.text({area.x + name.at, area.y - 5.0}, "st", name.band->label);
    std::vector<BandName> narrow = unnamed(all);
    const double left = text_width(plot.y.label, large_print) - 34.0 + 6.0;
    const double right = plot.y2 ? text_width(plot.y2->label, large_print) - 32.0 + 6.0 : 0.0;
    spread(narrow, {left, area.width - right});
    for (const BandName& name : narrow) {
        if (name.at < left - 0.5) continue;  // no room at all
        const double foot = std::clamp(name.middle(), name.at + 3.0, name.at + name.width() - 6.0);
        // Upright past the first row, whose names stand over their own bands, then over to its name.
        const Point bend{area.x + name.middle(), area.y - 15.0};
        svg.line({bend.x, area.y}, bend, "ld");
        svg.line(bend, {area.x + foot, area.y - head_high + 3.0}, "ld");
        svg.text({area.x + name.at, area.y - head_high}, "st", name.band->label);
    }
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

std::optional<Point> place_of(const Mark& mark, const Mapping& map, const Box& area) {
    const Point in = map(mark.at, mark.second_axis);  // within the area, but drawn whole on its border
    const auto outside = [](double v, double size) { return !(v >= -0.5 && v <= size + 0.5); };
    if (outside(in.x, area.width) || outside(in.y, area.height)) return std::nullopt;
    return Point{area.x + in.x, area.y + in.y};
}

constexpr double mark_radius = 3.2;

void draw_mark(Svg& svg, const Mark& mark, Point p) {
    constexpr double r = mark_radius;
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
}

void draw_mark_label(Svg& svg, const Mark& mark, Point p, const Box& area, Placer& placer) {
    const Spot above_left{{p.x - 6.0, p.y - 6.0}, Anchor::end}, above_right{{p.x + 6.0, p.y - 6.0}};
    const Spot below_left{{p.x - 8.0, p.y + 13.0}, Anchor::end}, below_right{{p.x + 8.0, p.y + 11.0}};
    const Spot far_below{{p.x - 8.0, p.y + 26.0}, Anchor::end},
        far_above{{p.x - 8.0, p.y - 20.0}, Anchor::end};
    const Spot farther_below{{p.x - 8.0, p.y + 39.0}, Anchor::end};
    const Spot farther_above{{p.x - 8.0, p.y - 33.0}, Anchor::end};
    if (mark.quiet) {
        // Names of passes stay with their squares, however full it is there.
        std::vector<Spot> spots = {below_right, above_left, below_left, above_right};
        if (!mark.second_axis)
            spots.insert(spots.end(), {far_above, farther_above, far_below, farther_below});
        const Spot spot = placer.choose(spots, mark.label, small_print);
        svg.text(spot.at, fmt::format("sm{}", anchor_style(spot.anchor)), mark.label);
        return;
    }
    const bool left = p.x - area.x > 0.5 * area.width;
    const Spot spots[] = {left ? above_left : above_right,
                          left ? above_right : above_left,
                          left ? below_left : below_right,
                          left ? below_right : below_left,
                          far_above,
                          far_below};
    const Spot spot = placer.choose(spots, mark.label, large_print);
    svg.text(spot.at, fmt::format("mk{}", anchor_style(spot.anchor)), mark.label);
}

// Labels after all marks, so that they keep clear of them; the loud ones first.
void draw_marks(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    Placer placer(area);
    for (const Line& line : plot.lines)
        for (Point p : within(line.points, map.x.range)) {
            p = map(p, line.second_axis);
            if (std::isfinite(p.x) && std::isfinite(p.y))
                placer.take({area.x + p.x - 0.5, area.y + p.y - 0.5, 1.0, 1.0});
        }
    for (const Mark& mark : plot.marks) {
        const std::optional<Point> p = place_of(mark, map, area);
        if (!p) continue;
        draw_mark(svg, mark, *p);
        placer.take({p->x - mark_radius, p->y - mark_radius, 2.0 * mark_radius, 2.0 * mark_radius});
    }
    for (const bool quiet : {false, true})
        for (const Mark& mark : plot.marks) {
            const std::optional<Point> p = place_of(mark, map, area);
            if (p && mark.quiet == quiet && !mark.label.empty()) draw_mark_label(svg, mark, *p, area, placer);
        }
}

void draw_grid(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    for (const double at : plot.y.ticks.at) svg.line({0.0, map.y(at)}, {area.width, map.y(at)}, "gr");
}

void draw_axes(Svg& svg, const Plot& plot, const Mapping& map, const Box& area) {
    const double head = has_band_labels(plot) ? head_high : 9.0;
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
    draw_band_names(svg, plot, map, area);
    draw_axes(svg, plot, map, area);
    draw_marks(svg, plot, map, area);
}

std::string draw(const Plot& plot) {
    Svg svg(plot.width, plot.height, plot.title);
    draw_into(svg, plot);
    return svg.finish();
}

}  // namespace bolt::plot
