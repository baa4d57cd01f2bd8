#include "game/plot/strips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/html.hpp"

namespace bolt::plot {

namespace {

constexpr double strip_width = 460.0, strip_right = 22.0, row_height = 38.0;

void draw_row(Svg& svg, const StripRow& row, const AxisScale& x, double left, double middle) {
    constexpr double radius = 2.6, room = 11.0;
    if (row.values.empty()) return;
    svg.rect({left + x(row.low), middle - room, x(row.high) - x(row.low), 2.0 * room}, "bf", 2.0);
    svg.line({left + x(row.median), middle - room - 2.0}, {left + x(row.median), middle + room + 2.0}, "me1");
    std::vector<double> sorted = row.values;
    std::sort(sorted.begin(), sorted.end());
    std::vector<SvgPoint> drawn;
    for (const double value : sorted) {
        SvgPoint p{left + x(value), middle};
        for (int step = 1; step < 9; ++step) {
            const bool covered = std::any_of(drawn.begin(), drawn.end(), [&](const SvgPoint& d) {
                return std::hypot(d.x - p.x, d.y - p.y) < 2.0 * radius;
            });
            if (!covered) break;
            p.y = middle + (step % 2 == 1 ? 1.0 : -1.0) * std::ceil(0.5 * step) * radius;
        }
        drawn.push_back(p);
        svg.circle(p, radius, row.style);
    }
    constexpr std::ptrdiff_t most = 5;
    for (auto same = sorted.begin(); same != sorted.end();) {
        const auto end = std::upper_bound(same, sorted.end(), *same);
        if (end - same > most)
            svg.text({left + x(*same) + 2.0 * radius, middle + 4.0}, "sm", fmt::format("×{}", end - same));
        same = end;
    }
}

}  // namespace

std::string draw(const StripPlot& plot) {
    const double rows_height = 4.0 + row_height * static_cast<double>(plot.rows.size());
    const AxisScale x{plot.ticks.range, strip_width - plot.left - strip_right, false};
    Svg svg(strip_width, rows_height + 32.0, plot.title);
    for (const double at : plot.ticks.values) {
        svg.line({plot.left + x(at), 4.0}, {plot.left + x(at), rows_height}, "gr");
        svg.text({plot.left + x(at), rows_height + 13.0}, "tk mid", number(at, plot.ticks.decimals));
    }
    double middle = 22.0;
    for (const StripRow& row : plot.rows) {
        svg.text({plot.left - 8.0, middle + 4.0}, "lb end", row.label);
        draw_row(svg, row, x, plot.left, middle);
        middle += row_height;
    }
    svg.text({plot.left + 0.5 * x.length, rows_height + 26.0}, "sm mid", plot.unit);
    return svg.finish();
}

}  // namespace bolt::plot
