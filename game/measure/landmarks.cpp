#include "game/measure/landmarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/math.hpp"
#include "game/statistics/summary.hpp"

namespace bolt::measure {

namespace {

constexpr double linear_share = 0.75, yield_share = 0.5;  // of the slope of the linear part
constexpr double loaded_share = 0.05;                     // of the peak: above it the joint is loaded

struct Regression {
    double slope = 0.0, mean_x = 0.0, mean_y = 0.0, error = 0.0;
    std::size_t count = 0;
};

// The samples of a curve with prefix sums, so that the regression over any of their ranges takes constant
// time.
class GradientTable {
  public:
    explicit GradientTable(const analysis::TorqueCurve& curve) : x_(curve.angle), y_(curve.torque) {
        // Sums are relative to the peak, where the precision is needed.
        const auto peak = std::max_element(y_.begin(), y_.end()) - y_.begin();
        x0_ = x_[static_cast<std::size_t>(peak)];
        y0_ = y_[static_cast<std::size_t>(peak)];
        sums_.resize(x_.size() + 1);
        for (std::size_t i = 0; i < x_.size(); ++i) {
            const double x = x_[i] - x0_, y = y_[i] - y0_;
            const Sums& s = sums_[i];
            sums_[i + 1] = {s.x + x, s.y + y, s.xx + x * x, s.xy + x * y, s.yy + y * y};
        }
    }

    // The regression line of the samples [begin, end).
    [[nodiscard]] Regression regression(std::size_t begin, std::size_t end) const {
        Regression r;
        r.count = end - begin;
        if (r.count < 2) return r;
        const auto n = static_cast<double>(r.count);
        const Sums &a = sums_[begin], &b = sums_[end];
        const double mx = (b.x - a.x) / n, my = (b.y - a.y) / n;
        const double sxx = (b.xx - a.xx) - n * mx * mx, sxy = (b.xy - a.xy) - n * mx * my;
        const double syy = (b.yy - a.yy) - n * my * my;
        r.mean_x = mx + x0_;
        r.mean_y = my + y0_;
        if (!(sxx > 0.0)) return r;
        r.slope = sxy / sxx;
        if (r.count > 2) r.error = std::sqrt(std::max(0.0, syy - r.slope * sxy) / (n - 2.0) / sxx);
        return r;
    }

    // Regression over the samples within half a window of sample `i`, and at least two to either side.
    [[nodiscard]] double gradient(std::size_t i, double window) const {
        const auto low = std::lower_bound(x_.begin(), x_.end(), x_[i] - 0.5 * window) - x_.begin();
        const auto high = std::upper_bound(x_.begin(), x_.end(), x_[i] + 0.5 * window) - x_.begin();
        const std::size_t begin = std::min(static_cast<std::size_t>(low), i >= 2 ? i - 2 : 0);
        const std::size_t end = std::min(x_.size(), std::max(static_cast<std::size_t>(high), i + 3));
        return regression(begin, end).slope;
    }

  private:
    struct Sums {
        double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    };
    const std::vector<double>&x_, &y_;
    double x0_ = 0.0, y0_ = 0.0;
    std::vector<Sums> sums_;
};

// The samples [begin, end) after the last one below `low` · peak, before the first one above `high` · peak.
struct Rise {
    std::size_t begin = 0, end = 0;
};

Rise rise_between(const analysis::TorqueCurve& curve, std::size_t peak, double low, double high) {
    const double top = curve.torque[peak];
    Rise rise{peak, peak + 1};
    while (rise.begin > 0 && curve.torque[rise.begin - 1] >= low * top) --rise.begin;
    rise.end = rise.begin;
    while (rise.end <= peak && curve.torque[rise.end] <= high * top) ++rise.end;
    return rise;
}

std::optional<FreeTurning> free_turning(const analysis::TorqueCurve& curve, std::size_t begin,
                                        std::size_t end) {
    if (end < begin + 3) return std::nullopt;
    const statistics::MeanDeviation torque =
        statistics::mean_deviation(std::span(curve.torque).subspan(begin, end - begin));
    const FreeTurning free{torque.mean, torque.deviation, curve.angle[begin], curve.angle[end - 1], torque.n};
    return free;
}

// The run-down ends before the rise, by the length of the rise's lower half.
std::optional<FreeTurning> run_down(const analysis::TorqueCurve& curve, std::size_t peak) {
    const Rise rise = rise_between(curve, peak, loaded_share, 0.5);
    const std::size_t last = std::min(rise.end, curve.size() - 1);
    const double length = curve.angle[last] - curve.angle[rise.begin];
    std::size_t end = rise.begin;
    while (end > 0 && curve.angle[end - 1] > curve.angle[rise.begin] - length) --end;
    return free_turning(curve, 0, end);
}

LinearPart linear_part(const analysis::TorqueCurve& curve, const GradientTable& table, Rise range) {
    const Regression r = table.regression(range.begin, range.end);
    LinearPart part;
    part.begin = curve.angle[range.begin];
    part.end = curve.angle[range.end - 1];
    part.slope = r.slope;
    part.slope_error = r.error;
    part.torque = r.mean_y + r.slope * (part.begin - r.mean_x);
    part.samples = r.count;
    return part;
}

// Replaces the range by the samples around its steepest one whose gradient is at least linear_share of the
// range's slope. The slope settles in a few rounds.
Rise settle_linear(const GradientTable& table, Rise range, std::size_t peak, double window) {
    for (int round = 0; round < 4; ++round) {
        const double enough = linear_share * table.regression(range.begin, range.end).slope;
        std::size_t middle = (range.begin + range.end) / 2;
        double steepest = table.gradient(middle, window);
        for (std::size_t i = range.begin; i < range.end; ++i)
            if (const double g = table.gradient(i, window); g > steepest) {
                steepest = g;
                middle = i;
            }
        Rise next{middle, middle + 1};
        while (next.begin > 0 && table.gradient(next.begin - 1, window) >= enough) --next.begin;
        while (next.end <= peak && table.gradient(next.end, window) >= enough) ++next.end;
        if (next.end - next.begin < min_linear_samples) return range;
        range = next;
    }
    return range;
}

// The first point from which the gradient stays low over an angle of `window`.
std::optional<Landmark> yield_point(const analysis::TorqueCurve& curve, const GradientTable& table,
                                    const LinearPart& linear, std::size_t after, double window) {
    const double low = yield_share * linear.slope;
    std::optional<std::size_t> first;
    for (std::size_t i = after; i < curve.size(); ++i) {
        if (table.gradient(i, window) >= low)
            first.reset();
        else if (!first)
            first = i;
        if (first && i >= *first + 3 && curve.angle[i] - curve.angle[*first] >= window)
            return Landmark{curve.angle[*first], curve.torque[*first]};
    }
    return std::nullopt;
}

void find_tightening(const analysis::TorqueCurve& curve, Landmarks& found) {
    const auto peak = static_cast<std::size_t>(std::max_element(curve.torque.begin(), curve.torque.end()) -
                                               curve.torque.begin());
    found.peak = {curve.angle[peak], curve.torque[peak]};
    if (!(found.peak.torque > 0.0)) {
        found.missing = "the torque never tightens";
        return;
    }
    found.free = run_down(curve, peak);
    Rise range = rise_between(curve, peak, 0.3, 0.7);
    if (range.end < range.begin + min_linear_samples) range = rise_between(curve, peak, 0.1, 0.9);
    if (range.end < range.begin + min_linear_samples) {
        found.missing = fmt::format("only {} samples between 10 % and 90 % of the highest torque",
                                    range.end - range.begin);
        return;
    }
    const GradientTable table(curve);
    const double window = 0.25 * (curve.angle[range.end - 1] - curve.angle[range.begin]);
    range = settle_linear(table, range, peak, window);
    const LinearPart linear = linear_part(curve, table, range);
    if (!(linear.slope > 0.0)) {
        found.missing = "the torque does not rise steadily";
        return;
    }
    found.linear = linear;
    const double level = found.free ? found.free->mean : 0.0;
    found.seat = linear.begin - (linear.torque - level) / linear.slope;
    found.yield = yield_point(curve, table, linear, range.end - 1, window);
}

void find_loosening(const analysis::TorqueCurve& curve, Landmarks& found) {
    const auto peak = static_cast<std::size_t>(std::min_element(curve.torque.begin(), curve.torque.end()) -
                                               curve.torque.begin());
    found.peak = {curve.angle[peak], curve.torque[peak]};
    std::size_t loaded = curve.size();  // after the last sample under load
    while (loaded > peak && std::abs(curve.torque[loaded - 1]) < loaded_share * std::abs(found.peak.torque))
        --loaded;
    if (loaded == curve.size()) return;
    found.released = curve.angle[loaded];
    found.free = free_turning(curve, loaded, curve.size());
}

}  // namespace

Landmarks find_landmarks(const analysis::TorqueCurve& curve) {
    Landmarks found;
    if (curve.empty()) {
        found.missing = "there are no samples";
        return found;
    }
    found.last = {curve.angle.back(), curve.torque.back()};
    if (curve.direction == joint::Direction::tighten)
        find_tightening(curve, found);
    else
        find_loosening(curve, found);
    return found;
}

}  // namespace bolt::measure
