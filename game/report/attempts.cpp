#include "game/report/attempts.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "game/report/html.hpp"
#include "game/report/plot.hpp"
#include "game/report/section.hpp"
#include "game/report/text.hpp"

namespace bolt::report {

namespace {

struct Measure {
    std::string_view name, unit, better;
    std::function<double(const Attempt&)> of;
    double least_top;  // the axis reaches at least so far
};

std::string learning_curve(std::span<const Attempt> attempts, const Measure& measure) {
    Plot plot;
    plot.width = 260.0;
    plot.height = 190.0;
    plot.title = fmt::format("{} over the attempts", measure.name);
    plot.x = {count_ticks(1, static_cast<int>(attempts.size()), 7), "attempt"};
    Line line;
    line.style = "ln p2";
    double top = measure.least_top;
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const Point p{static_cast<double>(i + 1), measure.of(attempts[i])};
        line.points.push_back(p);
        if (!std::isfinite(p.y)) continue;
        top = std::max(top, p.y);
        plot.marks.push_back({p, attempts[i].complete ? Shape::dot : Shape::ring,
                              attempts[i].complete ? "mpeak" : "mclamp", "", false});
    }
    const std::string better = measure.better.empty() ? "" : fmt::format(", {}", measure.better);
    plot.y = {covering_ticks(0.0, top, 4), fmt::format("{}{}", measure.unit, better)};
    plot.lines.push_back(std::move(line));
    return figure(fmt::format("<h3>{}</h3>", measure.name), draw(plot), "");
}

}  // namespace

Attempt attempt_of(const SessionData& session) {
    Attempt a;
    a.title = title_of(session.assembly);
    a.operator_name = session.header.operator_name;
    a.law = session.header.law;
    a.mode = session.header.mode;
    a.variant = session.header.variant;
    a.seed = session.header.seed;
    a.complete = session.complete;
    a.score = session.score;
    a.duration = session.duration;
    a.summary = summarise(session);
    return a;
}

std::string attempts_section(std::span<const Attempt> attempts) {
    std::string out = fmt::format("<p class=\"over\">Boltwright training report</p>\n<h1>{} attempts</h1>\n",
                                  attempts.size());
    bool cut_short = false;
    out +=
        "<div class=\"scroll\"><table><thead><tr><th "
        "class=\"n\">#</th><th>assembly</th><th>operator</th><th>mode</th>"
        "<th>law</th><th class=\"n\">seed</th><th class=\"n\">score</th><th class=\"n\">joints OK</th>"
        "<th class=\"n\">mean |torque error|</th><th class=\"n\">duration</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const Attempt& a = attempts[i];
        cut_short = cut_short || !a.complete;
        fmt::format_to(
            std::back_inserter(out),
            "<tr><td class=\"n\"><a href=\"#session-{0}\">{0}</a></td><td class=\"w\">{1}</td><td>{2}</td>"
            "<td>{3}{4}</td><td>{5}</td><td class=\"n\">{6}</td><td class=\"n\">{7}</td>"
            "<td class=\"n\">{8} <span class=\"of\">of {9}</span></td><td class=\"n\">{10} %</td>"
            "<td class=\"n\">{11}</td></tr>\n",
            i + 1, escape(a.title), escape(a.operator_name), escape(a.mode), a.complete ? "" : " (cut short)",
            escape(a.law), a.seed, number(a.score, 1), a.summary.ok, a.summary.joints,
            number(100.0 * a.summary.mean_torque_error, 1), duration_text(a.duration));
    }
    out += "</tbody></table></div>\n<h2>Learning curve</h2>\n<p class=\"note\">Attempts in the order given.";
    if (cut_short) out += " A ring is an attempt that was cut short.";
    out += "</p>\n<div class=\"grid quad\">\n";
    const Measure measures[] = {
        {"Score", "points", "higher is better", [](const Attempt& a) { return a.score; }, 100.0},
        {"Joints OK", "joints", "higher is better",
         [](const Attempt& a) { return static_cast<double>(a.summary.ok); },
         static_cast<double>(attempts.empty() ? 1 : attempts.front().summary.joints)},
        {"Mean |torque error|", "% of target", "lower is better",
         [](const Attempt& a) { return 100.0 * a.summary.mean_torque_error; }, 1.0},
        {"Duration", "min", "", [](const Attempt& a) { return a.duration / 60.0; }, 0.0},
    };
    for (const Measure& measure : measures) out += learning_curve(attempts, measure);
    return out + "</div>\n";
}

}  // namespace bolt::report
