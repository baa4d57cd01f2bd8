#include "game/measure/import_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"
#include "game/analysis/same_joint.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::measure {

namespace {

constexpr double least_torque = 0.01, most_torque = 2e5;  // N·m, of M4 to M39 with a wide margin
constexpr double least_turn = to_radians(1.0), most_turn = 2000.0 * pi;
constexpr double strength_12_9 = 1220e6, class_8_8_yield = 640e6;  // Pa, R_m of class 12.9 and R_p0.2 of 8.8
constexpr double steel = 210e9;                                    // Pa
constexpr double smallest_jump = to_radians(5.0);
constexpr double jump_factor = 5.0, usual_share = 0.95;

std::string_view turning_of(const Rig& rig) {
    return rig.direction == joint::Direction::tighten ? "tighten" : "loosen";
}

RigPosition angle_unit_position(const Rig& rig) {
    return rig.angle.channel.unit_position.line > 0 ? rig.angle.channel.unit_position : rig.angle.position;
}

// The thread of the rig, which its reader has checked.
std::optional<joint::ThreadSize> thread_of(const Rig& rig) {
    if (rig.thread.empty()) return std::nullopt;
    const auto thread = joint::parse_thread(rig.thread);
    return thread ? std::optional(*thread) : std::nullopt;
}

std::string bolt_text(const Rig& rig) {
    std::string text = rig.thread;
    if (rig.bolt_length > 0.0) text += fmt::format("x{:g}", rig.bolt_length * 1e3);
    return rig.property_class.empty() ? text : text + " of class " + rig.property_class;
}

}  // namespace

std::string quantity(double value, std::string_view unit) { return fmt::format("{:.4g} {}", value, unit); }

std::size_t extreme_index(const std::vector<double>& values) {
    const auto it = std::max_element(values.begin(), values.end(),
                                     [](double a, double b) { return std::abs(a) < std::abs(b); });
    return static_cast<std::size_t>(it - values.begin());
}

std::size_t unwrap_turns(std::vector<double>& angle) {
    if (angle.empty()) return 0;
    const auto [low, high] = std::minmax_element(angle.begin(), angle.end());
    if (*high - *low > 2.0 * pi + to_radians(1.0)) return 0;
    std::size_t wraps = 0;
    double turns = 0.0, before = angle.front();
    for (double& value : angle) {
        const double step = value - before;
        before = value;
        if (std::abs(step) > pi) {
            turns += step < 0.0 ? 2.0 * pi : -2.0 * pi;
            ++wraps;
        }
        value += turns;
    }
    return wraps;
}

std::optional<AngleJump> find_jump(std::span<const double> angle, double largest) {
    std::vector<double> moving;
    for (std::size_t i = 1; i < angle.size(); ++i)
        if (const double step = std::abs(angle[i] - angle[i - 1]); step > 0.0) moving.push_back(step);
    if (moving.empty()) return std::nullopt;
    const auto at =
        moving.begin() + static_cast<std::ptrdiff_t>(usual_share * static_cast<double>(moving.size() - 1));
    std::nth_element(moving.begin(), at, moving.end());
    const double limit = largest > 0.0 ? largest : std::max(smallest_jump, jump_factor * *at);
    for (std::size_t i = 1; i < angle.size(); ++i)
        if (std::abs(angle[i] - angle[i - 1]) > limit) return AngleJump{i, angle[i] - angle[i - 1], *at};
    return std::nullopt;
}

PlausibleRange plausible_torque(const Rig& rig) {
    const auto thread = thread_of(rig);
    if (!thread) return {least_torque, most_torque};
    const joint::ScrewThread& t = thread->thread;
    double strength = strength_12_9;
    if (const auto grade = joint::property_class(rig.property_class, t.d); grade) strength = grade->R_m;
    return {0.05 * t.d * t.A_s * 0.01 * class_8_8_yield, 0.4 * t.d * t.A_s * strength};
}

std::optional<PlausibleRange> plausible_slope(const Rig& rig) {
    const auto thread = thread_of(rig);
    if (!thread) return std::nullopt;
    const joint::ScrewThread& t = thread->thread;
    // Head and nut count as 0.9 d of the shank and 0.5 d of the core (VDI 2230). The nut and its overhang
    // take at most 1.5 d of the bolt's length.
    const auto compliance = [&](double grip) {
        return (0.9 * t.d / t.A_N() + (grip + 0.5 * t.d) / t.A_d3()) / steel;
    };
    const double shortest = rig.bolt_length > 0.0 ? std::max(0.3 * t.d, rig.bolt_length - 1.5 * t.d) : t.d;
    const double longest = rig.bolt_length > 0.0 ? rig.bolt_length : 20.0 * t.d;
    const double lead = t.pitch / (2.0 * pi);
    return PlausibleRange{0.08 * t.d * lead / (10.0 * compliance(longest)),
                          0.31 * t.d * lead / compliance(shortest)};
}

Status check_torque(const Rig& rig, const RigRun& run) {
    const Channel& channel = rig.torque.channel;
    const double extreme = run.torque[extreme_index(run.torque)];
    const bool tighten = rig.direction == joint::Direction::tighten;
    const PlausibleRange range = plausible_torque(rig);
    if (std::abs(extreme) < range.low || std::abs(extreme) > range.high)
        return fail(
            rig.error(channel.unit_position,
                      fmt::format("the largest torque of {} is {}", run.name, quantity(extreme, "N·m")),
                      rig.thread.empty()
                          ? fmt::format("{} to {} N·m; check unit, gain and lever", least_torque, most_torque)
                          : fmt::format("{} to {} N·m for a bolt {}; check unit, gain and lever",
                                        fmt::format("{:.2g}", range.low), fmt::format("{:.4g}", range.high),
                                        bolt_text(rig))));
    if ((extreme > 0.0) != tighten)
        return fail(rig.error(
            channel.reversed_position,
            fmt::format("the largest torque of {} is {}, but the rig is to {}", run.name,
                        quantity(extreme, "N·m"), turning_of(rig)),
            fmt::format("a torque that is {}; {} \"reversed\" of the torque, or check \"direction\"",
                        tighten ? "positive" : "negative", channel.reversed ? "remove" : "set")));
    return {};
}

Status check_angle(const Rig& rig, const RigRun& run) {
    const auto [low, high] = std::minmax_element(run.angle.begin(), run.angle.end());
    if (*high - *low < least_turn || *high - *low > most_turn)
        return fail(rig.error(
            angle_unit_position(rig),
            fmt::format("the nut of {} turns by {}", run.name, quantity(to_degrees(*high - *low), "degrees")),
            "1 degree to 1000 turns; check unit and gain of the angle"));
    const std::size_t peak = extreme_index(run.torque);
    const bool tighten = rig.direction == joint::Direction::tighten;
    const RigPosition sign =
        rig.angle.kind == AngleKind::points ? rig.angle.position : rig.angle.channel.reversed_position;
    if (tighten && run.angle[peak] <= run.angle.front())
        return fail(rig.error(
            sign,
            fmt::format("the angle of {} falls by {} up to the highest torque", run.name,
                        quantity(to_degrees(run.angle.front() - run.angle[peak]), "degrees")),
            fmt::format("an angle that rises while the nut is tightened; {} \"reversed\" of the angle",
                        rig.angle.channel.reversed ? "remove" : "set")));
    return {};
}

Status check_slope(const Rig& rig, const RigRun& run) {
    const auto range = plausible_slope(rig);
    const bool tighten = rig.direction == joint::Direction::tighten;
    const double slope =
        tighten
            ? (run.landmarks.linear ? run.landmarks.linear->slope : nan)
            : analysis::loosening_slope(analysis::make_torque_curve(run.angle, run.torque, rig.direction));
    if (!range || !std::isfinite(slope)) return {};
    // Loosening has no such lower bound: friction may nearly balance the pitch's share.
    if (slope <= range->high && (slope >= range->low || !tighten)) return {};
    return fail(rig.error(
        angle_unit_position(rig),
        fmt::format("the torque of {} {} by {}", run.name, tighten ? "rises" : "falls",
                    quantity(to_radians(slope), "N·m per degree")),
        fmt::format(
            "{:.2g} to {:.3g} N·m per degree for a bolt {}; check unit and gain of the angle and of "
            "the torque{}",
            to_radians(range->low), to_radians(range->high), bolt_text(rig),
            rig.bolt_length > 0.0 ? "" : ", or give \"bolt_length_mm\" of an unusually short or long bolt")));
}

}  // namespace bolt::measure
