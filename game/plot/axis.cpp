#include "game/plot/axis.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace bolt::plot {

namespace {

// A range that can be divided: finite, not empty, not so narrow that the ticks would be equal numbers.
Range sane(double low, double high) {
    if (!std::isfinite(low) || !std::isfinite(high)) return {0.0, 1.0};
    if (low > high) std::swap(low, high);
    const double least = 1e-9 * std::max({std::abs(low), std::abs(high), 1e-3});
    if (high - low < least)
        return low == 0.0 ? Range{0.0, 1.0} : Range{low - 0.5 * std::abs(low), high + 0.5 * std::abs(high)};
    return {low, high};
}

double decimal_step(double span, int about) {
    const double rough = span / std::max(1, about);
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double factor : {1.0, 2.0, 2.5, 5.0})
        if (rough <= factor * decade * 1.0000001) return factor * decade;
    return 10.0 * decade;
}

double degree_step(double span, int about) {
    const double rough = span / std::max(1, about);
    if (rough < 1.0) return decimal_step(span, about);
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

Ticks ticks_between(Range range, double first, double last, double step) {
    Ticks ticks;
    ticks.range = range;
    ticks.decimals = decimals_of(step);
    for (double k = first; k <= last + 0.5; k += 1.0) ticks.at.push_back(k * step);
    return ticks;
}

Ticks inside(Range range, double step) {
    constexpr double slack = 1e-9;  // a tick on the border is drawn
    return ticks_between(range, std::ceil(range.low / step - slack), std::floor(range.high / step + slack),
                         step);
}

}  // namespace

Ticks covering_ticks(double low, double high, int about) {
    const Range range = sane(low, high);
    const double step = decimal_step(range.span(), about);
    const double first = std::floor(range.low / step + 1e-9);
    const double last = std::ceil(range.high / step - 1e-9);
    return ticks_between({first * step, last * step}, first, last, step);
}

Ticks inner_ticks(Range range, int about) {
    const Range r = sane(range.low, range.high);
    return inside(r, decimal_step(r.span(), about));
}

Ticks degree_ticks(Range range, int about) {
    const Range r = sane(range.low, range.high);
    return inside(r, degree_step(r.span(), about));
}

Ticks count_ticks(int low, int high, int most) {
    const int count = std::max(1, high - low + 1);
    const int step = (count + std::max(1, most) - 1) / std::max(1, most);
    Ticks ticks;
    ticks.range = {low - 0.5, std::max(low, high) + 0.5};
    for (int i = low; i <= std::max(low, high); i += step) ticks.at.push_back(i);
    return ticks;
}

}  // namespace bolt::plot
