#include "haptics/servo/timing.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bolt::servo {

namespace {

std::string row(const char* name, const Histogram& h) {
    return fmt::format("  {:<9}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.1f}\n", name, 1e6 * quantile(h, 0.5),
                       1e6 * quantile(h, 0.99), 1e6 * quantile(h, 0.999),
                       1e-3 * static_cast<double>(h.greatest));
}

}  // namespace

HostAssessment assess_host(const Timing& timing, double rate, const HostRequirements& limits) {
    HostAssessment assessment;
    if (timing.ticks < limits.ticks || timing.wake_up.count == 0) {
        assessment.reasons.push_back(
            fmt::format("only {} ticks were timed; expected at least {}", timing.ticks, limits.ticks));
        assessment.violations = 1;
        return assessment;
    }
    const double period = 1.0 / rate;
    std::vector<std::string> within_limits;
    const auto check = [&](bool good, std::string reason) {
        (good ? within_limits : assessment.reasons).push_back(std::move(reason));
    };
    const double wake_up = quantile(timing.wake_up, 0.999), compute = quantile(timing.compute, 0.999);
    check(wake_up <= limits.wake_up * period,
          fmt::format(
              "99.9 % of the ticks began within {:.0f} µs of their deadline; expected at most {:.0f} µs",
              1e6 * wake_up, 1e6 * limits.wake_up * period));
    check(compute <= limits.compute * period,
          fmt::format("99.9 % of the ticks took up to {:.0f} µs; expected at most {:.0f} µs", 1e6 * compute,
                      1e6 * limits.compute * period));
    // Missed at the measured rate, or woken later than a whole period of the requested rate.
    const double deadlines = static_cast<double>(timing.ticks + timing.missed);
    const double missed =
        std::max(static_cast<double>(timing.missed) / deadlines, share_above(timing.wake_up, period));
    check(missed <= limits.missed,
          fmt::format("{:.2f} % of the deadlines were missed; expected at most {:.2f} %", 100.0 * missed,
                      100.0 * limits.missed));
    const double stall = 1e-9 * static_cast<double>(timing.period.greatest);
    check(stall <= limits.stall,
          fmt::format("the longest time without a tick was {:.1f} ms; expected at most {:.0f} ms",
                      1e3 * stall, 1e3 * limits.stall));
    assessment.adequate = assessment.reasons.empty();
    assessment.violations = assessment.reasons.size();
    assessment.reasons.insert(assessment.reasons.end(), within_limits.begin(), within_limits.end());
    return assessment;
}

std::string describe(const Timing& timing) {
    return fmt::format("  {:<9}{:>10}{:>10}{:>10}{:>10}\n", "µs", "median", "p99", "p99.9", "greatest") +
           row("wake-up", timing.wake_up) + row("compute", timing.compute) + row("period", timing.period) +
           fmt::format("  {} ticks, {} deadlines missed\n", timing.ticks, timing.missed);
}

}  // namespace bolt::servo
