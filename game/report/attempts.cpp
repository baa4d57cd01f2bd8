#include "game/report/attempts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "game/analysis/quartiles.hpp"
#include "game/plot/html.hpp"
#include "game/plot/text.hpp"
#include "game/report/guiding_study.hpp"
#include "game/report/learning_curves.hpp"
#include "game/report/section.hpp"

namespace bolt::report {

namespace {

constexpr std::string_view unnamed_person = "person without a name";

// "2.1 %"; a dash alone where there is none.
std::string percent(double share) {
    return std::isfinite(share) ? plot::number(100.0 * share, 1) + " %" : plot::number(share, 1);
}

// What a reader has to know about the names in the table.
std::string trainee_note(std::span<const Attempt> attempts) {
    const auto any = [&](const auto& holds) { return std::any_of(attempts.begin(), attempts.end(), holds); };
    std::string out;
    if (any([](const Attempt& a) { return a.operator_kind == session::OperatorKind::unrecorded; }))
        out +=
            "<p class=\"note\">Not recorded: an older program wrote the session; it does not record whether "
            "a person or a simulated trainee held the tool.</p>\n";
    if (any([](const Attempt& a) { return a.trainee == unnamed_person; }))
        out +=
            "<p class=\"note\">Sessions without a trainee's name may be of several people; <code>train "
            "--trainee NAME</code> records it.</p>\n";
    return out;
}

std::string attempts_table(std::span<const Attempt> attempts, bool alone) {
    std::string out =
        "<div class=\"scroll\"><table><thead><tr><th "
        "class=\"n\">#</th><th>assembly</th><th>task</th><th>variant</th><th>trainee</th><th>mode</th>"
        "<th>law</th><th class=\"n\">seed</th><th class=\"n\">score</th><th class=\"n\">joints OK</th>"
        "<th class=\"n\">mean |torque<br/>error|</th><th class=\"n\">duration</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const Attempt& a = attempts[i];
        const std::string number_text =
            alone ? fmt::format("{}", i + 1) : fmt::format("<a href=\"#session-{0}\">{0}</a>", i + 1);
        fmt::format_to(std::back_inserter(out),
                       "<tr><td class=\"n\">{0}</td><td class=\"w\">{1}</td><td>{2}</td>"
                       "<td>{3}</td><td>{4}</td><td>{5}{6}</td><td>{7}</td><td class=\"n\">{8}</td>"
                       "<td class=\"n\">{9}</td><td class=\"n\">{10} <span class=\"of\">of {11}</span></td>"
                       "<td class=\"n\">{12}</td><td class=\"n\">{13}</td></tr>\n",
                       number_text, plot::escape(a.title), plot::escape(a.task), plot::escape(a.variant),
                       plot::escape(a.trainee),
                       plot::escape(a.mode + (a.mode == "guided" && !a.guided ? ", no force" : "") +
                                    (a.view_help ? ", view help" : "")),
                       a.complete ? "" : " (cut short)", plot::escape(a.law), a.seed,
                       plot::number(a.score, 1), a.summary.ok, a.summary.joints,
                       percent(a.summary.mean_torque_error), plot::duration_text(a.duration));
    }
    return out + "</tbody></table></div>\n" + trainee_note(attempts);
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

std::string trainee_text(const session::Header& header) {
    const std::string name = session::trainee_name(header);
    switch (session::operator_kind(header)) {
        case session::OperatorKind::person:
            return name.empty() ? std::string(unnamed_person) : name;
        case session::OperatorKind::simulated:
            return name.empty() ? header.operator_name + " (simulated)"
                                : fmt::format("{} (simulated {})", name, header.operator_name);
        case session::OperatorKind::unrecorded:
            break;
    }
    return name + " (person or simulated: not recorded)";
}

Attempt attempt_of(const analysis::SessionData& session) {
    Attempt a;
    a.title = analysis::title_of(session.assembly);
    a.trainee = trainee_text(session.header);
    a.operator_kind = session::operator_kind(session.header);
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
    a.summary = analysis::summarise(session);

    const analysis::Feel& feel = session.feel;
    constexpr double unknown = analysis::Moment::nan;
    a.guided = feel.guided;
    a.view_help = session.header.view_help == "on";
    a.obstacles = feel.obstacles;
    std::vector<double> waited, placing;
    double seen = 0.0, looked = 0.0;
    for (const analysis::Arrival& arrival : feel.arrivals)
        if (arrival.wrench) {
            waited.push_back(arrival.waited);
            placing.push_back(arrival.placing);
            if (!std::isfinite(arrival.seen)) continue;
            seen += arrival.seen;
            looked += arrival.placing;
        }
    a.seen = looked > 0.0 ? seen / looked : unknown;
    a.to_nut = analysis::quartiles(std::move(waited)).median;
    a.near_nut = analysis::quartiles(std::move(placing)).median;
    a.bumps = feel.recorded ? static_cast<double>(feel.bumps.size()) : unknown;
    a.bump_time = feel.recorded ? 0.0 : unknown;
    for (const analysis::Bump& bump : feel.bumps) a.bump_time += bump.length;
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
        const std::string curves = learning_curves_section(attempts, group, !alone);
        compared = compared || !curves.empty();
        out += curves;
    }
    if (!compared)
        out +=
            "<p class=\"note\">A learning curve needs two attempts by the same trainee at the same assembly, "
            "task, variant and law.</p>\n";
    return out;
}

}  // namespace bolt::report
