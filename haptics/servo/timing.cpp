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

Verdict judge_host(const Timing& timing, double rate, const HostLimits& limits) {
    Verdict verdict;
    if (timing.ticks < limits.ticks || timing.wake_up.count == 0) {
        verdict.reasons.push_back(
            fmt::format("only {} ticks were timed; {} are needed to know", timing.ticks, limits.ticks));
        verdict.against = 1;
        return verdict;
    }
    const double period = 1.0 / rate;
    std::vector<std::string> kept;
    const auto hold = [&](bool good, std::string reason) {
        (good ? kept : verdict.reasons).push_back(std::move(reason));
    };
    const double wake_up = quantile(timing.wake_up, 0.999), compute = quantile(timing.compute, 0.999);
    hold(wake_up <= limits.wake_up * period,
         fmt::format(
             "99.9 % of the ticks began within {:.0f} µs of their deadline; at most {:.0f} µs is wanted",
             1e6 * wake_up, 1e6 * limits.wake_up * period));
    hold(compute <= limits.compute * period,
         fmt::format("99.9 % of the ticks took up to {:.0f} µs; at most {:.0f} µs is wanted", 1e6 * compute,
                     1e6 * limits.compute * period));
    // What was missed when it was timed, or what wakes later than a whole period of the rate asked for.
    const double deadlines = static_cast<double>(timing.ticks + timing.missed);
    const double missed =
        std::max(static_cast<double>(timing.missed) / deadlines, share_above(timing.wake_up, period));
    hold(missed <= limits.missed,
         fmt::format("{:.2f} % of the deadlines were missed; at most {:.2f} % is wanted", 100.0 * missed,
                     100.0 * limits.missed));
    const double stall = 1e-9 * static_cast<double>(timing.period.greatest);
    hold(stall <= limits.stall,
         fmt::format("the longest time without a tick was {:.1f} ms; at most {:.0f} ms is wanted",
                     1e3 * stall, 1e3 * limits.stall));
    verdict.good = verdict.reasons.empty();
    verdict.against = verdict.reasons.size();
    verdict.reasons.insert(verdict.reasons.end(), kept.begin(), kept.end());
    return verdict;
}

std::string describe(const Timing& timing) {
    return fmt::format("  {:<9}{:>10}{:>10}{:>10}{:>10}\n", "µs", "median", "p99", "p99.9", "greatest") +
           row("wake-up", timing.wake_up) + row("compute", timing.compute) + row("period", timing.period) +
           fmt::format("  {} ticks, {} deadlines missed\n", timing.ticks, timing.missed);
}

}  // namespace bolt::servo
