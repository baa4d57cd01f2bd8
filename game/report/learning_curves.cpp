#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "game/analysis/session_data.hpp"
#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/report/attempts.hpp"
#include "game/statistics/summary.hpp"

namespace bolt::report {

namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t min_for_median = 3;  // trainees

struct LearningMeasure {
    std::string_view name, unit, better;
    std::function<double(const Attempt&)> value;
    double min_top;  // the axis reaches at least this value
};

std::vector<LearningMeasure> learning_measures(const Attempt& first) {
    return {
        {"Score", "points", "higher is better", [](const Attempt& a) { return a.score; }, 100.0},
        {"Joints OK", "joints", "higher is better",
         [](const Attempt& a) { return static_cast<double>(a.summary.ok); },
         static_cast<double>(first.summary.joints)},
        {"Mean |torque error|", "% of target", "lower is better",
         [](const Attempt& a) { return 100.0 * a.summary.mean_torque_error; }, 1.0},
        {"Duration", "min", "", [](const Attempt& a) { return a.duration / 60.0; }, 0.0},
    };
}

// Attempts at one task, with the extent that the axes of all trainees share.
struct TaskAttempts {
    std::span<const Attempt> attempts;
    std::vector<Indices> trainees;
    std::size_t max_attempts = 0;  // of one trainee

    [[nodiscard]] const Attempt& first_of(const Indices& trainee) const { return attempts[trainee.front()]; }
};

double highest_value(const TaskAttempts& task, const LearningMeasure& measure) {
    double top = measure.min_top;
    for (const Indices& trainee : task.trainees)
        for (const std::size_t i : trainee)
            if (const double value = measure.value(task.attempts[i]); std::isfinite(value))
                top = std::max(top, value);
    return top;
}

// Median of the n-th attempts (from 0) of all trainees of that kind; NaN below three trainees.
double median_of_trainees(const TaskAttempts& task, const LearningMeasure& measure, session::TraineeKind kind,
                          std::size_t n) {
    std::vector<double> values;
    for (const Indices& trainee : task.trainees) {
        if (task.first_of(trainee).trainee_kind != kind || trainee.size() <= n) continue;
        const double value = measure.value(task.attempts[trainee[n]]);
        if (std::isfinite(value)) values.push_back(value);
    }
    if (values.size() < min_for_median) return std::numeric_limits<double>::quiet_NaN();
    return statistics::quartiles(std::move(values)).median;
}

// Empty if no attempt of the trainee has the value.
std::string trainee_plot(const TaskAttempts& task, const Indices& trainee, const LearningMeasure& measure) {
    const auto known = [&](std::size_t i) { return std::isfinite(measure.value(task.attempts[i])); };
    if (std::none_of(trainee.begin(), trainee.end(), known)) return {};
    const Attempt& first = task.first_of(trainee);
    plot::Plot plot;
    plot.width = 260.0;
    plot.height = 190.0;
    plot.title = fmt::format("{} over the attempts of {}", measure.name, first.trainee);
    plot.x = {plot::count_ticks(1, static_cast<int>(task.max_attempts), 7), "attempt of this trainee"};
    const std::string better = measure.better.empty() ? "" : fmt::format(", {}", measure.better);
    plot.y = {plot::covering_ticks(0.0, highest_value(task, measure), 4),
              fmt::format("{}{}", measure.unit, better)};
    plot::PlotLine median{{}, "ln cl"}, curve{{}, "ln p2"};
    for (std::size_t n = 0; n < task.max_attempts; ++n) {
        const double value = median_of_trainees(task, measure, first.trainee_kind, n);
        if (std::isfinite(value)) median.points.push_back({static_cast<double>(n + 1), value});
    }
    for (std::size_t n = 0; n < trainee.size(); ++n) {
        const Attempt& attempt = task.attempts[trainee[n]];
        const plot::SvgPoint p{static_cast<double>(n + 1), measure.value(attempt)};
        curve.points.push_back(p);
        if (!std::isfinite(p.y)) continue;
        plot.markers.push_back({p, attempt.complete ? plot::MarkerShape::dot : plot::MarkerShape::ring,
                                attempt.complete ? "mpeak" : "mclamp", "", false});
    }
    if (median.points.size() > 1) plot.lines.push_back(std::move(median));
    plot.lines.push_back(std::move(curve));
    return plot::figure(fmt::format("<h4>{}</h4>", measure.name), plot::draw(plot), "");
}

std::string task_text(const Attempt& a) {
    std::string text = a.title;
    for (const std::string& detail : {a.task, a.variant, a.law})
        if (!detail.empty()) text += ", " + detail;
    return text;
}

// "1, 4, 7": the attempts as the page numbers them.
std::string attempt_numbers(const Indices& trainee, bool linked) {
    std::string text;
    for (const std::size_t i : trainee) {
        if (!text.empty()) text += ", ";
        text += linked ? fmt::format("<a href=\"#session-{0}\">{0}</a>", i + 1) : fmt::format("{}", i + 1);
    }
    return text;
}

std::string change_text(double first, double latest, int decimals) {
    return std::isfinite(first) && std::isfinite(latest) ? plot::signed_number(latest - first, decimals)
                                                         : "–";
}

// One row a trainee: the first attempt, the latest, and what changed between them.
std::string trainees_table(const TaskAttempts& task, bool linked) {
    std::string out =
        "<div class=\"scroll\"><table><thead><tr><th>trainee</th><th>attempts</th><th class=\"n\">first "
        "score</th><th class=\"n\">latest score</th><th class=\"n\">change</th><th class=\"n\">best "
        "score</th><th class=\"n\">latest<br/>joints OK</th><th class=\"n\">latest mean<br/>|torque "
        "error|</th><th class=\"n\">latest<br/>duration</th></tr></thead><tbody>\n";
    for (const Indices& trainee : task.trainees) {
        const Attempt &first = task.first_of(trainee), &latest = task.attempts[trainee.back()];
        double best = first.score;
        for (const std::size_t i : trainee) best = std::max(best, task.attempts[i].score);
        const double error = 100.0 * latest.summary.mean_torque_error;
        fmt::format_to(
            std::back_inserter(out),
            "<tr><td class=\"w\">{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>"
            "<td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{} <span class=\"of\">of "
            "{}</span></td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            plot::escape(first.trainee), attempt_numbers(trainee, linked), plot::number(first.score, 1),
            plot::number(latest.score, 1),
            trainee.size() > 1 ? change_text(first.score, latest.score, 1) : "–", plot::number(best, 1),
            latest.summary.ok, latest.summary.joints,
            std::isfinite(error) ? plot::number(error, 1) + " %" : "–", plot::duration_text(latest.duration));
    }
    return out + "</tbody></table></div>\n";
}

std::string reading_note(const TaskAttempts& task) {
    std::string out = "<p class=\"note\">The attempts of each trainee are numbered in the order given.";
    bool ring = false;
    for (const Indices& trainee : task.trainees)
        ring = ring || (trainee.size() > 1 && std::any_of(trainee.begin(), trainee.end(), [&](std::size_t i) {
                            return !task.attempts[i].complete;
                        }));
    if (task.trainees.size() > 1) out += " All trainees' plots have the same axes.";
    if (ring) out += " A ring is an attempt that was cut short.";
    if (task.trainees.size() >= min_for_median)
        out +=
            " The dashed line is the median of all trainees at their first, second, … attempt, where at "
            "least three have one; people and simulated trainees have medians of their own.";
    return out + "</p>\n";
}

}  // namespace

std::vector<Indices> split_by_trainee(std::span<const Attempt> attempts, std::span<const std::size_t> group) {
    std::vector<Indices> trainees;
    for (const std::size_t i : group) {
        const auto found = std::find_if(trainees.begin(), trainees.end(), [&](const Indices& trainee) {
            const Attempt& first = attempts[trainee.front()];
            return first.trainee_kind == attempts[i].trainee_kind && first.trainee == attempts[i].trainee;
        });
        if (found == trainees.end())
            trainees.push_back({i});
        else
            found->push_back(i);
    }
    return trainees;
}

std::string learning_curves_section(std::span<const Attempt> attempts, std::span<const std::size_t> group,
                                    bool linked) {
    TaskAttempts task{attempts, split_by_trainee(attempts, group)};
    for (const Indices& trainee : task.trainees)
        task.max_attempts = std::max(task.max_attempts, trainee.size());
    if (task.max_attempts < 2) return {};
    const Attempt& first = attempts[group.front()];
    std::string out = fmt::format("<h2>Learning curve{}: {}</h2>\n{}", task.trainees.size() > 1 ? "s" : "",
                                  plot::escape(task_text(first)), reading_note(task));
    if (task.trainees.size() > 1) out += trainees_table(task, linked);
    for (const Indices& trainee : task.trainees) {
        if (trainee.size() < 2) continue;
        fmt::format_to(std::back_inserter(out),
                       "<div class=\"trainee\"><h3>{} <span class=\"of\">attempts {}</span></h3>\n<div "
                       "class=\"grid quad\">\n",
                       plot::escape(task.first_of(trainee).trainee), attempt_numbers(trainee, linked));
        for (const LearningMeasure& measure : learning_measures(first))
            out += trainee_plot(task, trainee, measure);
        out += "</div></div>\n";
    }
    return out;
}

}  // namespace bolt::report
