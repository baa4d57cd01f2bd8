#include "game/analysis/same_joint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "game/statistics/summary.hpp"

namespace bolt::analysis {

namespace {

constexpr double length_tolerance = 0.5e-3;  // m; nominal lengths differ by 2 mm or more

double factor_of(double ratio) { return std::max(ratio, 1.0 / ratio); }

}  // namespace

std::string different_peaks(const TorqueCurve& simulated, const std::vector<MeasuredCurve>& measured) {
    std::vector<double> peaks;
    for (const MeasuredCurve& cycle : measured) peaks.push_back(share_of_peak(cycle.curve, 1.0));
    const double median = statistics::quartiles(peaks).median, own = share_of_peak(simulated, 1.0);
    const double ratio = factor_of(own / median);
    if (ratio <= largest_peak_ratio) return {};
    return fmt::format(
        "the peak torques differ by a factor of {:.2f} (virtual {:.4g} N·m, measured {:.4g} N·m); expected "
        "at most {:g} for one joint",
        ratio, own, median, largest_peak_ratio);
}

double loosening_slope(const TorqueCurve& curve) {
    const auto peak = static_cast<std::size_t>(std::min_element(curve.torque.begin(), curve.torque.end()) -
                                               curve.torque.begin());
    if (curve.empty() || !(curve.torque[peak] < 0.0)) return nan;
    const double loaded = near_zero_share * std::abs(curve.torque[peak]);
    std::size_t end = curve.size();  // after the last sample under load
    while (end > peak + 1 && std::abs(curve.torque[end - 1]) < loaded) --end;
    if (end == curve.size()) return nan;
    return std::abs(curve.torque[peak]) / (curve.angle[end] - curve.angle[peak]);
}

std::string different_slopes(const TorqueCurve& simulated, const std::vector<MeasuredCurve>& measured,
                             std::span<const CycleComparison> cycles) {
    const bool loosening = simulated.direction == joint::Direction::loosen;
    std::vector<double> ratios;  // virtual over measured
    for (std::size_t i = 0; i < cycles.size(); ++i)
        ratios.push_back(loosening
                             ? loosening_slope(simulated) / loosening_slope(measured[i].curve)
                             : 1.0 + slope_error(simulated, measured[i].curve, cycles[i].alignment.shift));
    const double ratio = statistics::quartiles(ratios).median;
    const double largest = loosening ? largest_fall_ratio : largest_slope_ratio;
    if (!(ratio > 0.0) || factor_of(ratio) <= largest) return {};
    return fmt::format(
        "the torque {} by a factor of {:.2f} {} than measured; expected at most {:g} for one joint",
        loosening ? "falls after the breakaway" : "rises in linearity", factor_of(ratio),
        ratio > 1.0 ? "more steeply" : "less steeply", largest);
}

Result<RecordedBolt> recorded_bolt(const MeasuredRecord& measured) {
    RecordedBolt bolt;
    bolt.property_class = measured.property_class;
    const auto wrong_line = [&](std::string_view key, const std::string& what, std::string expected) {
        Error error;
        error.code = ErrorCode::bad_content;
        error.file = measured.file;
        error.what = fmt::format("the line \"# {}:\" is wrong: {}", key, what);
        error.expected = std::move(expected);
        return fail(std::move(error));
    };
    if (!measured.thread.empty()) {
        const auto thread = joint::parse_thread(measured.thread);
        if (!thread) return wrong_line("thread", thread.error().what, thread.error().expected);
        bolt.thread = *thread;
    }
    if (measured.bolt_length.empty()) return bolt;
    const std::string& text = measured.bolt_length;
    double length = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (problem != std::errc() || end != text.data() + text.size() || !(length > 0.0))
        return wrong_line("bolt_length_mm", fmt::format("'{}' is not a length", text),
                          "millimetres, such as 75");
    bolt.length = 1e-3 * length;
    return bolt;
}

std::string different_bolt(const joint::JointDesign& design, const RecordedBolt& bolt) {
    if (bolt.thread) {
        const joint::ThreadSize &own = design.thread, &other = *bolt.thread;
        if (own.thread.d != other.thread.d || own.thread.pitch != other.thread.pitch)
            return fmt::format("the measured thread is {}×{:g}, the joint's {}×{:g}", other.size.name,
                               other.thread.pitch * 1e3, own.size.name, own.thread.pitch * 1e3);
    }
    if (bolt.length && std::abs(*bolt.length - design.bolt_length) > length_tolerance)
        return fmt::format("the measured bolt is {:g} mm long, the joint's {:g} mm", *bolt.length * 1e3,
                           design.bolt_length * 1e3);
    if (!bolt.property_class.empty() && bolt.property_class != design.bolt_class.name)
        return fmt::format("the measured property class is {}, the joint's {}", bolt.property_class,
                           design.bolt_class.name);
    return {};
}

}  // namespace bolt::analysis
