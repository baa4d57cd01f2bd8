#include "game/report/attempts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <tuple>

#include "game/report/guiding_study.hpp"
#include "game/report/html.hpp"
#include "game/report/plot.hpp"
#include "game/report/quartiles.hpp"
#include "game/report/section.hpp"
#include "game/report/text.hpp"

namespace bolt::report {

namespace {

struct Measure {
    std::string_view name, unit, better;
    std::function<double(const Attempt&)> of;
    double least_top;  // the axis reaches at least so far
};

// Of the attempts named; nothing where the measure says nothing about any of them.
std::string learning_curve(std::span<const Attempt> attempts, const std::vector<std::size_t>& group,
                           const Measure& measure) {
    const auto says = [&](std::size_t i) { return std::isfinite(measure.of(attempts[i])); };
    if (std::none_of(group.begin(), group.end(), says)) return {};
    Plot plot;
    plot.width = 260.0;
    plot.height = 190.0;
    plot.title = fmt::format("{} over the attempts", measure.name);
    plot.x = {count_ticks(1, static_cast<int>(group.size()), 7), "attempt"};
    Line line;
    line.style = "ln p2";
    double top = measure.least_top;
    for (std::size_t i = 0; i < group.size(); ++i) {
        const Attempt& attempt = attempts[group[i]];
        const Point p{static_cast<double>(i + 1), measure.of(attempt)};
        line.points.push_back(p);
        if (!std::isfinite(p.y)) continue;
        top = std::max(top, p.y);
        plot.marks.push_back({p, attempt.complete ? Shape::dot : Shape::ring,
                              attempt.complete ? "mpeak" : "mclamp", "", false});
    }
    const std::string better = measure.better.empty() ? "" : fmt::format(", {}", measure.better);
    plot.y = {covering_ticks(0.0, top, 4), fmt::format("{}{}", measure.unit, better)};
    plot.lines.push_back(std::move(line));
    return figure(fmt::format("<h3>{}</h3>", measure.name), draw(plot), "");
}

std::string group_text(const Attempt& a) {
    std::string text = a.title;
    for (const std::string& part : {a.task, a.variant, a.law})
        if (!part.empty()) text += ", " + part;
    return text;
}

std::string group_section(std::span<const Attempt> attempts, const std::vector<std::size_t>& group) {
    std::string numbers;
    bool cut_short = false;
    for (const std::size_t i : group) {
        fmt::format_to(std::back_inserter(numbers), "{}{}", numbers.empty() ? "" : ", ", i + 1);
        cut_short = cut_short || !attempts[i].complete;
    }
    std::string out =
        fmt::format("<h2>Learning curve: {}</h2>\n<p class=\"note\">Attempts {}, in the order given.",
                    escape(group_text(attempts[group.front()])), numbers);
    if (cut_short) out += " A ring is an attempt that was cut short.";
    out += "</p>\n<div class=\"grid quad\">\n";
    const Measure measures[] = {
        {"Score", "points", "higher is better", [](const Attempt& a) { return a.score; }, 100.0},
        {"Joints OK", "joints", "higher is better",
         [](const Attempt& a) { return static_cast<double>(a.summary.ok); },
         static_cast<double>(attempts[group.front()].summary.joints)},
        {"Mean |torque error|", "% of target", "lower is better",
         [](const Attempt& a) { return 100.0 * a.summary.mean_torque_error; }, 1.0},
        {"Duration", "min", "", [](const Attempt& a) { return a.duration / 60.0; }, 0.0},
    };
    for (const Measure& measure : measures) out += learning_curve(attempts, group, measure);
    return out + "</div>\n";
}

// "2.1 %"; a dash alone where there is none.
std::string percent(double share) {
    return std::isfinite(share) ? number(100.0 * share, 1) + " %" : number(share, 1);
}

std::string attempts_table(std::span<const Attempt> attempts, bool alone) {
    std::string out =
        "<div class=\"scroll\"><table><thead><tr><th "
        "class=\"n\">#</th><th>assembly</th><th>task</th><th>variant</th><th>operator</th><th>mode</th>"
        "<th>law</th><th class=\"n\">seed</th><th class=\"n\">score</th><th class=\"n\">joints OK</th>"
        "<th class=\"n\">mean |torque<br/>error|</th><th class=\"n\">duration</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const Attempt& a = attempts[i];
        const std::string number_text =
            alone ? fmt::format("{}", i + 1) : fmt::format("<a href=\"#session-{0}\">{0}</a>", i + 1);
        fmt::format_to(
            std::back_inserter(out),
            "<tr><td class=\"n\">{0}</td><td class=\"w\">{1}</td><td>{2}</td>"
            "<td>{3}</td><td>{4}</td><td>{5}{6}</td><td>{7}</td><td class=\"n\">{8}</td>"
            "<td class=\"n\">{9}</td><td class=\"n\">{10} <span class=\"of\">of {11}</span></td>"
            "<td class=\"n\">{12}</td><td class=\"n\">{13}</td></tr>\n",
            number_text, escape(a.title), escape(a.task), escape(a.variant), escape(a.operator_name),
            escape(a.mode + (a.mode == "guided" && !a.guided ? ", no force" : "") +
                   (a.view_help ? ", view help" : "")),
            a.complete ? "" : " (cut short)", escape(a.law), a.seed, number(a.score, 1), a.summary.ok,
            a.summary.joints, percent(a.summary.mean_torque_error), duration_text(a.duration));
    }
    return out + "</tbody></table></div>\n";
}

}  // namespace

std::vector<std::vector<std::size_t>> attempt_groups(std::span<const Attempt> attempts) {
    const auto key = [](const Attempt& a) { return std::tie(a.assembly, a.title, a.task, a.variant, a.law); };
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const auto same = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
            return key(attempts[group.front()]) == key(attempts[i]);
        });
        if (same == groups.end())
            groups.push_back({i});
        else
            same->push_back(i);
    }
    return groups;
}

Attempt attempt_of(const SessionData& session) {
    Attempt a;
    a.title = title_of(session.assembly);
    a.operator_name = session.header.operator_name;
    a.assembly = session.header.assembly;
    a.task = session.header.task;
    a.law = session.header.law;
    a.mode = session.header.mode;
    a.variant = session.header.variant;
    a.seed = session.header.seed;
    a.complete = session.complete;
    a.finished = session.finished;
    a.score = session.score;
    a.duration = session.duration;
    a.summary = summarise(session);

    const Feel& feel = session.feel;
    constexpr double unknown = Moment::nan;
    a.guided = feel.guided;
    a.view_help = session.header.view_help == "on";
    a.obstacles = feel.obstacles;
    a.simulated = session.header.operator_name != "person";
    std::vector<double> waited, placing;
    double seen = 0.0, looked = 0.0;
    for (const Arrival& arrival : feel.arrivals)
        if (arrival.wrench) {
            waited.push_back(arrival.waited);
            placing.push_back(arrival.placing);
            if (!std::isfinite(arrival.seen)) continue;
            seen += arrival.seen;
            looked += arrival.placing;
        }
    a.seen = looked > 0.0 ? seen / looked : unknown;
    a.to_nut = quartiles(std::move(waited)).median;
    a.near_nut = quartiles(std::move(placing)).median;
    a.bumps = feel.recorded ? static_cast<double>(feel.bumps.size()) : unknown;
    a.bump_time = feel.recorded ? 0.0 : unknown;
    for (const Bump& bump : feel.bumps) a.bump_time += bump.length;
    const double greatest = feel.device ? feel.device->force : unknown;
    a.greatest_change = feel.force.greatest / greatest;
    a.usual_change = feel.force.p99 / greatest;
    return a;
}

std::string attempts_section(std::span<const Attempt> attempts, bool alone) {
    std::string out = fmt::format("<p class=\"over\">Boltwright training report</p>\n<h1>{} attempts</h1>\n",
                                  attempts.size());
    const std::string study = guiding_study(attempts) + view_study(attempts);
    out += alone ? study + attempts_table(attempts, alone) : attempts_table(attempts, alone) + study;
    if (alone && !study.empty()) return out;
    bool compared = false;
    for (const std::vector<std::size_t>& group : attempt_groups(attempts)) {
        if (group.size() < 2) continue;
        compared = true;
        out += group_section(attempts, group);
    }
    if (!compared)
        out +=
            "<p class=\"note\">A learning curve needs two attempts at the same assembly, task, variant and "
            "law.</p>\n";
    return out;
}

}  // namespace bolt::report
