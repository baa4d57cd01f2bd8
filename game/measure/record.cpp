#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "engine/base/csv.hpp"
#include "engine/base/math.hpp"
#include "game/measure/import.hpp"
#include "game/statistics/summary.hpp"

namespace bolt::measure {

namespace {

// The samples to write: see record_step.
std::vector<std::size_t> recorded_samples(const RigRun& run) {
    std::vector<std::size_t> kept;
    const double step = to_radians(record_step);
    for (std::size_t begin = 0; begin < run.angle.size();) {
        std::size_t end = begin + 1, strongest = begin;
        while (end < run.angle.size() && std::abs(run.angle[end] - run.angle[begin]) < step) {
            if (std::abs(run.torque[end]) > std::abs(run.torque[strongest])) strongest = end;
            ++end;
        }
        kept.push_back(begin);
        if (strongest != begin) kept.push_back(strongest);
        begin = end;
    }
    return kept;
}

double u_at_peak(const RigRun& run) {
    double torque = -1.0, u = 0.0;
    for (std::size_t i = 0; i < run.torque.size(); ++i)
        if (std::abs(run.torque[i]) > torque) {
            torque = std::abs(run.torque[i]);
            u = run.u_torque[i];
        }
    return u;
}

// Angles of landmarks are those of the curve, which begins at the run's first sample.
void put_tightening(std::string& out, const Landmarks& l) {
    const auto line = [&](std::string_view name, const std::string& text) {
        out += fmt::format("  {:<12} {}\n", name, text);
    };
    line("run-down", l.free ? fmt::format("{:.4g} ± {:.2g} N·m (standard deviation) from {:.1f}° to {:.1f}°",
                                          l.free->mean, l.free->deviation, to_degrees(l.free->begin),
                                          to_degrees(l.free->end))
                            : "not in this run, or fewer than 3 samples");
    if (!l.linear) {
        line("linear part", "not found: " + l.missing);
        return;
    }
    line("seat", fmt::format("{:.2f}°{}", to_degrees(*l.seat),
                             l.free ? "" : ", if the nut turned freely without torque"));
    line("linear part",
         fmt::format("{:.4g} ± {:.2g} N·m/° (standard error) from {:.2f}° to {:.2f}°, {:.1f} N·m to {:.1f} "
                     "N·m, {} samples",
                     to_radians(l.linear->slope), to_radians(l.linear->slope_error),
                     to_degrees(l.linear->begin), to_degrees(l.linear->end), l.linear->at(l.linear->begin),
                     l.linear->at(l.linear->end), l.linear->samples));
    line("yield", l.yield
                      ? fmt::format("from {:.1f} N·m at {:.2f}°", l.yield->torque, to_degrees(l.yield->angle))
                      : "not reached");
    line("peak", fmt::format("{:.2f} N·m at {:.2f}°", l.peak.torque, to_degrees(l.peak.angle)));
}

void put_loosening(std::string& out, const Landmarks& l) {
    out +=
        fmt::format("  {:<12} {:.2f} N·m at {:.2f}°\n", "breakaway", l.peak.torque, to_degrees(l.peak.angle));
    out += l.released ? fmt::format("  {:<12} below 5 % of the breakaway from {:.1f}° on\n", "released",
                                    to_degrees(*l.released))
                      : fmt::format("  {:<12} not within this run\n", "released");
    if (l.free)
        out += fmt::format("  {:<12} {:.3g} ± {:.2g} N·m (standard deviation)\n", "free", l.free->mean,
                           l.free->deviation);
}

void put_run(std::string& out, const Rig& rig, const RigRun& run) {
    out += fmt::format("{}: {} samples, {:.4g} per second, {:.3f} s\n", run.name, run.torque.size(), run.rate,
                       run.time.back() - run.time.front());
    if (rig.torque.tare > 0.0) out += fmt::format("  {:<12} {:.4g} N·m subtracted\n", "zero", run.zero);
    rig.direction == joint::Direction::tighten ? put_tightening(out, run.landmarks)
                                               : put_loosening(out, run.landmarks);
    const TorqueChannel& t = rig.torque;
    const double u_share = std::sqrt(square(t.channel.relative_uncertainty) +
                                     (t.lever > 0.0 ? square(t.lever_uncertainty / t.lever) : 0.0));
    out +=
        fmt::format("  {:<12} U = {:.2g} N·m at the largest torque, {:.2g} % of a slope, {:.2g}° (k = 2)\n",
                    "uncertainty", 2.0 * u_at_peak(run), 200.0 * u_share, to_degrees(2.0 * run.u_angle));
    if (run.noise > 0.0)
        out += fmt::format("  {:<12} {:.2g} N·m (standard deviation) removed by the low pass\n", "noise",
                           run.noise);
    for (const std::string& note : run.notes) out += fmt::format("  {:<12} {}\n", "check", note);
}

std::string spread_line(std::string_view name, std::span<const double> values, std::string_view unit) {
    if (values.empty()) return {};
    const statistics::MeanDeviation s = statistics::mean_deviation(values);
    if (s.n < 2) return {};
    return fmt::format("  {:<12} {:.4g} ± {:.2g} {}, {} runs\n", name, s.mean, s.deviation, unit, s.n);
}

}  // namespace

void name_uniquely(std::vector<RigRun>& runs) {
    std::set<std::string> taken;
    for (RigRun& run : runs) {
        const std::string name = run.name;
        for (int number = 2; !taken.insert(run.name).second; ++number)
            run.name = fmt::format("{} ({})", name, number);
    }
}

std::string record_csv(const Rig& rig, const std::vector<RigRun>& runs) {
    std::string out = fmt::format("# rig: {}\n", rig.title);
    if (!rig.source.empty()) out += fmt::format("# source: {}\n", rig.source);
    if (!rig.thread.empty()) out += fmt::format("# thread: {}\n", rig.thread);
    if (rig.bolt_length > 0.0) out += fmt::format("# bolt_length_mm: {:g}\n", rig.bolt_length * 1e3);
    if (!rig.property_class.empty()) out += fmt::format("# property_class: {}\n", rig.property_class);
    out +=
        "# u_torque_Nm: combined standard uncertainty (GUM) of resolution, calibration and lever; U = 2 u\n";
    out += "cycle,time_s,angle_deg,torque_Nm,u_torque_Nm\n";
    for (const RigRun& run : runs) {
        const std::string name = csv_field(run.name);
        for (const std::size_t i : recorded_samples(run))
            out += fmt::format("{},{:.6g},{:.4f},{:.6g},{:.3g}\n", name, run.time[i],
                               to_degrees(run.angle[i]), run.torque[i], run.u_torque[i]);
    }
    return out;
}

std::string summary_text(const Rig& rig, const std::vector<RigRun>& runs) {
    std::string out = rig.title + "\n";
    if (!rig.source.empty()) out += fmt::format("measured by: {}\n", rig.source);
    if (rig.thread.empty())
        out +=
            "check: the rig does not name the thread, so units were checked only coarsely; expected "
            "\"thread\", and \"property_class\" and \"bolt_length_mm\" if they are known\n";
    std::vector<double> free, slopes, yields, peaks;
    for (const RigRun& run : runs) {
        put_run(out, rig, run);
        const Landmarks& l = run.landmarks;
        if (l.free) free.push_back(l.free->mean);
        if (l.linear) slopes.push_back(to_radians(l.linear->slope));
        if (l.yield) yields.push_back(l.yield->torque);
        peaks.push_back(l.peak.torque);
    }
    if (runs.size() < 2) return out;
    out += "all runs: mean ± standard deviation between runs\n";
    out += spread_line(rig.direction == joint::Direction::tighten ? "run-down" : "free", free, "N·m");
    out += spread_line("linear part", slopes, "N·m/°");
    out += spread_line("yield", yields, "N·m");
    out += spread_line(rig.direction == joint::Direction::tighten ? "peak" : "breakaway", peaks, "N·m");
    return out;
}

}  // namespace bolt::measure
