#include "game/report/attempts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "game/analysis/session_data.hpp"
#include "game/people/inventory.hpp"
#include "game/plot/html.hpp"
#include "game/plot/strips.hpp"
#include "game/report/report.hpp"
#include "game/statistics/rank_tests.hpp"

namespace bolt::report {

namespace {

constexpr std::string_view unnamed_person = "person without a name";

// "2.1 %", or a dash if the share is not finite.
std::string percent(double share) {
    return std::isfinite(share) ? plot::number(100.0 * share, 1) + " %" : plot::number(share, 1);
}

// Notes on the trainees' names in the table.
std::string trainee_note(std::span<const Attempt> attempts) {
    const auto any = [&](const auto& test) { return std::any_of(attempts.begin(), attempts.end(), test); };
    std::string out;
    if (any([](const Attempt& a) { return a.trainee_kind == session::TraineeKind::unrecorded; }))
        out +=
            "<p class=\"note\">Not recorded: an older program wrote the session; it does not record whether "
            "a person or a simulated trainee held the tool.</p>\n";
    if (any([](const Attempt& a) { return a.trainee == unnamed_person; }))
        out +=
            "<p class=\"note\">Sessions without a trainee's name may be of several people; <code>train "
            "--trainee NAME</code> records it.</p>\n";
    return out;
}

std::string attempts_table(std::span<const Attempt> attempts, bool overview_only) {
    std::string out =
        "<div class=\"scroll\"><table><thead><tr><th "
        "class=\"n\">#</th><th>assembly</th><th>task</th><th>variant</th><th>trainee</th><th>mode</"
        "th><th>law</th><th class=\"n\">seed</th><th class=\"n\">score</th><th class=\"n\">joints OK</th><th "
        "class=\"n\">mean |torque<br/>error|</th><th class=\"n\">duration</th></tr></thead><tbody>\n";
    for (std::size_t i = 0; i < attempts.size(); ++i) {
        const Attempt& a = attempts[i];
        const std::string number_text =
            overview_only ? fmt::format("{}", i + 1) : fmt::format("<a href=\"#session-{0}\">{0}</a>", i + 1);
        fmt::format_to(
            std::back_inserter(out),
            "<tr><td class=\"n\">{0}</td><td "
            "class=\"w\">{1}</td><td>{2}</td><td>{3}</td><td>{4}</td><td>{5}{6}</td><td>{7}</td><td "
            "class=\"n\">{8}</td><td class=\"n\">{9}</td><td class=\"n\">{10} <span class=\"of\">of "
            "{11}</span></td><td class=\"n\">{12}</td><td class=\"n\">{13}</td></tr>\n",
            number_text, plot::escape(a.title), plot::escape(a.task), plot::escape(a.variant),
            plot::escape(a.trainee),
            plot::escape(a.mode + (a.mode == "guided" && !a.guided ? ", no force" : "") +
                         (a.view_help ? ", view help" : "")),
            a.complete ? "" : " (cut short)", plot::escape(a.law), a.seed, plot::number(a.score, 1),
            a.summary.ok, a.summary.joints, percent(a.summary.mean_torque_error),
            plot::duration_text(a.duration));
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

std::string trainee_text(const session::Header& header, const TraineeNames& names) {
    const std::string name = session::trainee_name(header);
    switch (session::trainee_kind(header)) {
        case session::TraineeKind::person: {
            const content::Person person = people::person_of(header, names.people);
            if (person == content::Person{}) return std::string(unnamed_person);
            return names.show || person.code.empty() ? content::name_and_code(person) : person.code;
        }
        case session::TraineeKind::simulated:
            return name.empty() ? header.trainee_profile + " (simulated)"
                                : fmt::format("{} (simulated {})", name, header.trainee_profile);
        case session::TraineeKind::unrecorded:
            break;
    }
    return name + " (person or simulated: not recorded)";
}

Attempt attempt_of(const analysis::SessionData& session, const TraineeNames& names) {
    Attempt a;
    a.title = analysis::title_of(session.assembly);
    a.trainee = trainee_text(session.header, names);
    const content::Person person = people::person_of(session.header, names.people);
    a.person = person.code.empty() ? person.name : person.code;
    a.trainee_kind = session::trainee_kind(session.header);
    a.assembly = session.header.assembly;
    a.task = lesson::name(session.header.task);
    a.law = joint::name(session.header.law);
    a.mode = lesson::name(session.header.mode);
    a.variant = session.header.variant;
    a.seed = session.header.seed;
    a.complete = session.complete;
    a.finished = session.finished;
    a.score = session.score;
    a.duration = session.duration;
    a.summary = analysis::summarise(session);

    const analysis::HapticMetrics& metrics = session.metrics;
    constexpr double unknown = nan;
    a.guided = metrics.guided;
    a.view_help = session.header.view_help.value_or(false);
    a.obstacles = metrics.has_contact_models;
    std::vector<double> times_to_nut, times_near_nut;
    double visible_time = 0.0, near_time = 0.0;
    for (const analysis::Arrival& arrival : metrics.arrivals)
        if (arrival.wrench) {
            times_to_nut.push_back(arrival.duration);
            times_near_nut.push_back(arrival.near_nut);
            if (!std::isfinite(arrival.nut_visible)) continue;
            visible_time += arrival.nut_visible;
            near_time += arrival.near_nut;
        }
    a.visible_share = near_time > 0.0 ? visible_time / near_time : unknown;
    a.time_to_nut = statistics::quartiles(std::move(times_to_nut)).median;
    a.time_near_nut = statistics::quartiles(std::move(times_near_nut)).median;
    a.obstacle_contacts =
        metrics.has_contacts_and_faults ? static_cast<double>(metrics.obstacle_contacts.size()) : unknown;
    a.contact_time = metrics.has_contacts_and_faults ? 0.0 : unknown;
    for (const analysis::ObstacleContact& contact : metrics.obstacle_contacts)
        a.contact_time += contact.length;
    const double greatest = metrics.device_limits ? metrics.device_limits->force : unknown;
    a.greatest_change = metrics.force.greatest / greatest;
    a.p99_change = metrics.force.p99 / greatest;
    return a;
}

std::string attempts_section(std::span<const Attempt> attempts, bool overview_only) {
    std::string out = fmt::format("<p class=\"over\">Boltwright training report</p>\n<h1>{} attempts</h1>\n",
                                  attempts.size());
    const std::string study = guiding_study(attempts) + view_study(attempts);
    out += overview_only ? study + attempts_table(attempts, overview_only)
                         : attempts_table(attempts, overview_only) + study;
    if (overview_only && !study.empty()) return out;
    bool compared = false;
    for (const std::vector<std::size_t>& group : attempt_groups(attempts)) {
        const std::string curves = learning_curves_section(attempts, group, !overview_only);
        compared = compared || !curves.empty();
        out += curves;
    }
    if (!compared)
        out +=
            "<p class=\"note\">A learning curve needs two attempts by the same trainee at the same assembly, "
            "task, variant and law.</p>\n";
    return out;
}

namespace {

using plot::put;

// A quantity that a study compares.
struct StudyMeasure {
    std::string_view name, unit;
    double Attempt::*value;
    double scale;
    int decimals;
};

constexpr StudyMeasure measures[] = {
    {"Time to get onto the nut or screw", "s, median over the steps", &Attempt::time_to_nut, 1.0, 2},
    {"Time near it until it is held", "s, median over the steps", &Attempt::time_near_nut, 1.0, 2},
    {"Nut or screw in sight meanwhile", "% of the time with 60 % of it visible or more",
     &Attempt::visible_share, 100.0, 0},
    {"Contacts with obstacles", "in a lesson", &Attempt::obstacle_contacts, 1.0, 1},
    {"Time in contact with obstacles", "s in a lesson", &Attempt::contact_time, 1.0, 2},
    {"Duration of the lesson", "min", &Attempt::duration, 1.0 / 60.0, 2},
    {"Score", "points", &Attempt::score, 1.0, 1},
    {"Largest change of force in 1 ms", "% of the device's greatest", &Attempt::greatest_change, 100.0, 2},
    {"Usual change of force in 1 ms", "% of the device's greatest, 99th percentile", &Attempt::p99_change,
     100.0, 3},
};

// An aid that some attempts have and others have not.
struct StudyFactor {
    std::string_view heading, title, with, without;
    bool Attempt::*has;
    std::string_view model;  // how it works for simulated trainees
};

constexpr StudyFactor guiding{"guiding",    "with and without guiding", "guided",
                              "not guided", &Attempt::guided,           ""};
constexpr StudyFactor view{
    "view help",
    "with and without view help",
    "view help",
    "by hand",
    &Attempt::view_help,
    " A trainee that sees less of jaw and nut or screw than it wants presses V: after a glance of 0.3 s "
    "and a transition of 0.35 s the eye is in the view that the program found. If that shows too little as "
    "well, the trainee moves its head as without the help. Without the help the eye begins in the "
    "assembly's first view and moves about it at 60° a second. After a glance of 0.3 s it moves up, down "
    "or to a side at random, and continues while more becomes visible. After 30° without gain it moves "
    "back and tries another direction, until enough is visible or every direction is worse. The hand waits "
    "meanwhile. The less is visible, the less accurately the wrench is placed. Nothing else differs: that "
    "people forget the key, tire, or lose their way in a view is not modelled."};

using AttemptList = std::vector<const Attempt*>;

std::vector<double> values_of(const AttemptList& group, const StudyMeasure& measure) {
    std::vector<double> values;
    for (const Attempt* a : group) {
        const double value = a->*measure.value * measure.scale;
        if (std::isfinite(value)) values.push_back(value);
    }
    return values;
}

plot::StripRow strip_row(std::string_view label, const std::vector<double>& values, std::string_view style) {
    const statistics::Quartiles q = statistics::quartiles(values);
    return {std::string(label), values, q.low, q.median, q.high, style};
}

std::string strip_plot(const AttemptList& with, const AttemptList& without, const StudyMeasure& measure,
                       const StudyFactor& factor) {
    const std::vector<double> a = values_of(with, measure), b = values_of(without, measure);
    if (a.empty() || b.empty()) return {};
    const double high =
        std::max(*std::max_element(a.begin(), a.end()), *std::max_element(b.begin(), b.end()));
    const plot::StripPlot strips{fmt::format("{}, {}, {}", measure.name, measure.unit, factor.title),
                                 std::string(measure.unit),
                                 {strip_row(factor.with, a, "mpeak"), strip_row(factor.without, b, "mclamp")},
                                 plot::covering_ticks(0.0, high > 0.0 ? high : 1.0, 5)};
    return plot::figure(fmt::format("<h3>{}</h3>", measure.name), plot::draw(strips), "");
}

std::string quartile_text(const statistics::Quartiles& q, int decimals) {
    return fmt::format("{} <span class=\"of\">({} to {})</span>", plot::number(q.median, decimals),
                       plot::number(q.low, decimals), plot::number(q.high, decimals));
}

std::string p_text(double p) { return p < 0.001 ? "&lt; 0.001" : plot::number(p, 3); }

// Quartiles of both groups, and their difference with its test; Holm's correction is for all rows.
std::string study_table(const AttemptList& with, const AttemptList& without, const StudyFactor& factor) {
    struct Row {
        const StudyMeasure* measure;
        std::vector<double> with, without;
    };
    std::vector<Row> rows;
    std::vector<double> p;
    for (const StudyMeasure& m : measures) {
        Row row{&m, values_of(with, m), values_of(without, m)};
        if (row.with.empty() && row.without.empty()) continue;
        p.push_back(statistics::rank_sum_test(row.with, row.without).p_two_sided);
        rows.push_back(std::move(row));
    }
    const std::vector<double> adjusted = statistics::holm(p);
    std::string out;
    put(out,
        "<div class=\"scroll\"><table><thead><tr><th>median (quartiles)</th><th class=\"n\">{}</th><th "
        "class=\"n\">{}</th><th class=\"n\">difference<br/>(95 % interval)</th><th "
        "class=\"n\">p</th></tr></thead><tbody>\n",
        factor.with, factor.without);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const StudyMeasure& m = *rows[i].measure;
        const statistics::Shift shift = statistics::independent_shift(rows[i].with, rows[i].without);
        // A few lessons give no interval of 95 %; 1e-9 is for rounding.
        const std::string difference =
            shift.confidence < 0.95 - 1e-9
                ? plot::number(shift.estimate, m.decimals)
                : quartile_text({shift.interval.low, shift.estimate, shift.interval.high, 0}, m.decimals);
        put(out,
            "<tr><td class=\"w\">{}, {}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
            "class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            m.name, m.unit, quartile_text(statistics::quartiles(rows[i].with), m.decimals),
            quartile_text(statistics::quartiles(rows[i].without), m.decimals), difference,
            p_text(adjusted[i]));
    }
    return out +
           "</tbody></table></div>\n<p class=\"note\">Difference: the median difference over all pairs of "
           "one lesson with the aid and one without it (Hodges and Lehmann), and its interval from the exact "
           "distribution. p: two-sided rank sum test, exact below 100 lessons, after Holm's correction for "
           "the rows of this table. Both take the lessons as independent.</p>\n";
}

std::string study_part(const AttemptList& with, const AttemptList& without, const StudyFactor& factor) {
    const Attempt& first = *with.front();
    const bool simulated = first.trainee_kind == session::TraineeKind::simulated;
    std::string out;
    put(out, "<h2>With and without {}: {}, {}{}</h2>\n", factor.heading, plot::escape(first.title),
        plot::escape(first.trainee), first.obstacles ? "" : ", without obstacles");
    const auto finished = [](const AttemptList& group) {
        return std::count_if(group.begin(), group.end(), [](const Attempt* a) { return a->finished; });
    };
    put(out, "<p>{}n = {} {} and {} {}; finished: {} and {}.{}</p>\n",
        simulated ? "<strong>These trainees are simulated:</strong> this shows what the program does to a "
                    "model of a hand, not what it does to people. "
        : first.trainee_kind == session::TraineeKind::unrecorded
            ? "These sessions do not record whether a person or a simulated trainee held the tool. "
            : "",
        with.size(), factor.with, without.size(), factor.without, finished(with), finished(without),
        simulated ? factor.model : "");
    out += study_table(with, without, factor);
    out += "<div class=\"grid\">\n";
    for (const StudyMeasure& m : measures) out += strip_plot(with, without, m, factor);
    return out +
           "</div>\n<p class=\"note\">Each dot is a lesson; the box is from the lower to the upper quartile "
           "(type 7), the line is the median.</p>\n";
}

std::string study(std::span<const Attempt> attempts, const StudyFactor& factor, bool Attempt::*equal_in) {
    const auto key = [&](const Attempt& a) {
        return std::tie(a.assembly, a.title, a.task, a.variant, a.law, a.mode, a.trainee, a.trainee_kind,
                        a.obstacles, a.*equal_in);
    };
    std::string out;
    AttemptList compared;
    for (const Attempt& attempt : attempts) {
        const auto comparable = [&](const Attempt* other) { return key(*other) == key(attempt); };
        if (std::any_of(compared.begin(), compared.end(), comparable)) continue;
        compared.push_back(&attempt);
        AttemptList with, without;
        for (const Attempt& a : attempts)
            if (a.complete && comparable(&a)) (a.*factor.has ? with : without).push_back(&a);
        if (!with.empty() && !without.empty()) out += study_part(with, without, factor);
    }
    return out;
}

}  // namespace

std::string guiding_study(std::span<const Attempt> attempts) {
    return study(attempts, guiding, &Attempt::view_help);
}

std::string view_study(std::span<const Attempt> attempts) { return study(attempts, view, &Attempt::guided); }

}  // namespace bolt::report
