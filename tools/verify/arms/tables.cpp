#include "tools/verify/arms/tables.hpp"

#include <fmt/format.h>

namespace bolt::arm_validation {

namespace {

std::string marked(const Fact& fact, double unit) {
    const char* mark = fact.origin == Origin::published    ? ""
                       : fact.origin == Origin::unverified ? "†"
                                                           : "\\*";
    return fmt::format("{:.3g}{}", fact.value / unit, mark);
}

bool as_torque(const ArmFacts& arm) { return arm.announced().limits.torque > 0.0; }

std::string stable_text(const StableRange& range) {
    if (range.open) return fmt::format("> {:.2g}", range.used * max_factor);
    if (range.stable == 0.0) return fmt::format("< {:.2g}", range.used * min_factor);
    return fmt::format("{:.{}f}", range.stable, range.stable < 100.0 ? 1 : 0);
}

std::string spring_row(const ArmFacts& arm, const SpringResult& s, double announced, const char* unit) {
    const std::string margin = s.held.open ? fmt::format("> {:.1f}", max_factor)
                                           : fmt::format("{:.1f}", s.held.stable / s.held.used);
    return fmt::format("| {} | {:.4g} {} | {:.4g} | {} | {} | {} | {} |", arm.name, announced, unit,
                       s.held.used, stable_text(s.held), margin, stable_text(s.uncontrolled),
                       stable_text(s.free));
}

constexpr std::string_view facts_head =
    "| arm | mass, kg | friction, N | step of the encoders, µm | delay, ms | force, N | torque, N·m |\n"
    "|---|---|---|---|---|---|---|\n";
constexpr std::string_view spring_head =
    "| arm | announced | used | largest stable | margin | without the controller | no hand |\n"
    "|---|---|---|---|---|---|---|\n";
constexpr std::string_view feel_head =
    "| arm | net energy, mJ | most at any time, mJ | swing at rest, µm | at the rim, µm | step in 1 ms | "
    "no hand: net, mJ | swing, µm |\n|---|---|---|---|---|---|---|---|\n";
constexpr std::string_view approach_head =
    "| arm | guiding | way | time, s | bumps | misses | force of contact, N: median, p95, max | change in "
    "1 ms, N: p95, max |\n|---|---|---|---|---|---|---|---|\n";

std::string approach_row(const ArmFacts& arm, const char* guiding, const ApproachSummary& s) {
    return fmt::format(
        "| {} | {} | {:.2f} | {:.1f} | {:.2f} | {} of {} | {:.1f}, {:.1f}, {:.1f} | {:.2f}, {:.2f} |",
        arm.name, guiding, s.way_ratio, s.time, s.bumps, s.missed, s.count, s.force_median, s.force_p95,
        s.force_max, s.step_p95, s.step_max);
}

}  // namespace

std::vector<std::string> rows_of(const ArmResult& r) {
    const ArmFacts& a = *r.arm;
    const force::OutputLimits limits = a.announced().limits;
    const bool torque = as_torque(a);
    std::vector<std::string> rows;
    rows.push_back(fmt::format("| {} | {} | {} | {} | {} | {:g} | {} |", a.name, marked(a.mass, 1.0),
                               marked(a.friction, 1.0), marked(a.encoder, 1e-6), limits.delay, limits.force,
                               torque ? fmt::format("{:g}", limits.torque) : "–"));
    rows.push_back(spring_row(a, r.contact, limits.stiffness, "N/m"));
    rows.push_back(
        spring_row(a, r.nut, torque ? limits.torsion : limits.stiffness, torque ? "N·m/rad" : "N/m"));
    rows.push_back(fmt::format("| {} | {:.1f} | {:.2f} | {:.0f} | {:.0f} | {:.1f} % | {:.2f} | {:.0f} |",
                               a.name, 1e3 * r.held.record.energy, 1e3 * r.held.record.greatest_energy,
                               1e6 * r.held.late_swing, 1e6 * r.swing_at_rim,
                               step_percent(r.held, a.announced()), 1e3 * r.free.record.energy,
                               1e6 * r.free.late_swing));
    return rows;
}

std::vector<std::string> rows_of(const ApproachResult& result) {
    return {approach_row(*result.arm, "no", result.free), approach_row(*result.arm, "yes", result.guided)};
}

std::string to_markdown(const ValidationResult& result) {
    std::array<std::string, 4> bodies;
    for (const ArmResult& arm : result.arms) {
        const std::vector<std::string> rows = rows_of(arm);
        for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i] += rows[i] + "\n";
    }
    std::string text = fmt::format("{}{}\nContact with the casing, N/m at the hand:\n\n{}{}", facts_head,
                                   bodies[0], spring_head, bodies[1]);
    text += fmt::format("\nA tightened nut, N/m at the grip or N·m/rad:\n\n{}{}", spring_head, bodies[2]);
    text += fmt::format("\nAt the announced limits:\n\n{}{}", feel_head, bodies[3]);
    if (result.approaches.empty()) return text;
    text += fmt::format("\n{} blind approaches to a nut:\n\n{}", result.approaches.front().free.count,
                        approach_head);
    for (const ApproachResult& approach : result.approaches)
        for (const std::string& row : rows_of(approach)) text += row + "\n";
    return text;
}

Result<std::string> replace_tables(std::string_view text, std::string_view tables) {
    const std::size_t begin = text.find(tables_begin), end = text.find(tables_end);
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin)
        return fail(ErrorCode::failed, "the file has no place for the tables",
                    fmt::format("the lines {} and {}", tables_begin, tables_end));
    return fmt::format("{}\n\n{}\n{}", text.substr(0, begin + tables_begin.size()), tables, text.substr(end));
}

}  // namespace bolt::arm_validation
