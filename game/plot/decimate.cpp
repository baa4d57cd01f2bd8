#include "game/plot/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::plot {

namespace {

bool is_gap(const Point& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); }

void append_run(std::vector<Point>& out, std::span<const Point> run) {
    const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
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

std::vector<Point> decimate(std::span<const Point> points, double column) {
    std::vector<Point> out;
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

std::vector<Point> within(std::span<const Point> points, Range x) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Point> out;
    bool drawing = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point& p = points[i];
        const bool gap = is_gap(p);
        const bool inside = !gap && p.x >= x.low && p.x <= x.high;
        if (inside && !drawing && i > 0 && !is_gap(points[i - 1])) out.push_back(points[i - 1]);
        if (inside || drawing) out.push_back(p);
        if (drawing && !inside && !gap) out.push_back({nan, nan});
        drawing = inside;
    }
    return out;
}

}  // namespace bolt::plot
