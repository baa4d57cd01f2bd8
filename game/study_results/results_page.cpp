// The page with the results of a study.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/html.hpp"
#include "game/plot/plot.hpp"
#include "game/plot/strips.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

using plot::put;

constexpr double high_shift_confidence = 0.95 - 1e-9;  // 1e-9 is for rounding

std::string shown(const MeasureInfo& info, double value) {
    return plot::number(value * info.scale, info.decimals);
}

std::string p_text(double p) { return p < 0.001 ? "&lt; 0.001" : plot::number(p, 3); }

std::string simulated_banner(const StudyData& data) {
    if (!data.simulated()) return {};
    const auto simulated = std::count_if(data.participants.begin(), data.participants.end(),
                                         [](const ParticipantState& s) { return s.progress.simulated; });
    return fmt::format(
        "<p class=\"banner\"><strong>Simulated participants.</strong> {} of {} participants are programs: "
        "their lessons are those of simulated trainees, and their answers are random numbers. This page "
        "shows how the design works; it says nothing about people.</p>\n",
        simulated, data.participants.size());
}

std::string facts(const content::Study& study, const StudyData& data) {
    std::int64_t first = 0, last = 0;
    double set_back = 0.0;
    const Interruptions interruptions = interruptions_of(data);
    for (const ParticipantState& state : data.participants) {
        first = first == 0 ? state.progress.begun : std::min(first, state.progress.begun);
        last = std::max(last, state.progress.latest);
        set_back += state.progress.clock_set_back;
    }
    std::string out = "<dl class=\"facts\">\n";
    out += plot::fact("participants",
                      fmt::format("{} of {} planned", data.participants.size(), study.design.participants));
    out += plot::fact("did every step", std::to_string(data.completed()));
    out += plot::fact("withdrew", std::to_string(data.withdrawn));
    if (first != 0)
        out += plot::fact("dates", time_text(first).substr(0, 10) + " to " + time_text(last).substr(0, 10));
    out += plot::fact("interrupted lessons",
                      interruptions.lessons == 0
                          ? std::string("0")
                          : fmt::format("{} (continued: {}, begun again: {})", interruptions.lessons,
                                        interruptions.continued, interruptions.begun_again));
    if (set_back > 0.0)
        out += plot::fact("clock set back", fmt::format("by {} in total", plot::duration_text(set_back)));
    out += plot::fact("plan", fmt::format("{:016x}", study.checksum));
    out += plot::fact("plan changed for", changed_plans(data));
    return out + "</dl>\n";
}

// The row of a measure in one condition: n, minimum, maximum, mean with interval, median, quartiles.
void put_row(std::string& out, const MeasureResult& measure, const MeasureSample& sample, bool first) {
    const MeasureInfo& info = measure.info;
    put(out,
        "<tr><td class=\"w\">{}</td><td class=\"w\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td class=\"n\">{} <span class=\"of\">[{}, {}]</span></td><td "
        "class=\"n\">{}</td><td class=\"n\">{} <span class=\"of\">to {}</span></td></tr>\n",
        first ? fmt::format("{} <span class=\"of\">{}</span>", plot::escape(info.title), info.unit) : "",
        plot::escape(sample.name), sample.values.size(), shown(info, sample.min), shown(info, sample.max),
        plot::number(sample.mean * info.scale, info.decimals + 1), shown(info, sample.mean_interval.low),
        shown(info, sample.mean_interval.high), shown(info, sample.quartiles.median),
        shown(info, sample.quartiles.low), shown(info, sample.quartiles.high));
}

void put_published(std::string& out, const MeasureResult& measure) {
    const content::PublishedValue& value = *measure.published;
    put(out,
        "<tr><td></td><td class=\"w\">{}{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td "
        "class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">–</td><td class=\"n\">–</td></tr>\n",
        plot::escape(value.source),
        measure.published_is_possible.value_or(true) ? "" : " <span class=\"bad\">impossible mean</span>",
        value.n, value.min ? fmt::format("{:g}", *value.min) : "–",
        value.max ? fmt::format("{:g}", *value.max) : "–", plot::number(value.mean, value.decimals));
}

std::string description_table(const Results& results, bool objective) {
    std::string rows;
    bool impossible = false;
    for (const MeasureResult& measure : results.measures) {
        if (measure.info.definition.empty() == objective) continue;
        bool first = true;
        for (const std::vector<MeasureSample>* samples : {&measure.conditions, &measure.other_times})
            for (const MeasureSample& sample : *samples) {
                if (sample.values.empty() && samples == &measure.conditions && !measure.other_times.empty())
                    continue;  // a form that is not presented in the conditions
                put_row(rows, measure, sample, first);
                first = false;
            }
        if (measure.published != nullptr) put_published(rows, measure);
        impossible = impossible || !measure.published_is_possible.value_or(true);
    }
    if (rows.empty()) return {};
    std::string out = fmt::format(
        "<h2>{}</h2>\n<div class=\"scroll\"><table><thead><tr><th>measure</th><th>condition</th><th "
        "class=\"n\">n</th><th class=\"n\">min</th><th class=\"n\">max</th><th class=\"n\">mean [95 "
        "%]</th><th class=\"n\">median</th><th "
        "class=\"n\">quartiles</th></tr></thead><tbody>\n{}</tbody></table></div>\n",
        objective ? "Measured in the lessons" : "Judged by the participants", rows);
    if (impossible)
        out +=
            "<p class=\"note\">Impossible mean: no set of that many answers on this scale has this mean "
            "(GRIM test, Brown and Heathers 2017). The printed value rests on other data than the "
            "publication says.</p>\n";
    return out;
}

std::string definitions(const Results& results) {
    std::string out = "<p class=\"note\">";
    for (const MeasureResult& measure : results.measures)
        if (!measure.info.definition.empty())
            put(out, "{}: {}. ", plot::escape(measure.info.title), plot::escape(measure.info.definition));
    return out + "</p>\n";
}

// At most `most` characters (UTF-8).
std::string shortened(const std::string& text, std::size_t most) {
    std::size_t characters = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if ((static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U) continue;
        if (++characters > most) return text.substr(0, i) + "…";
    }
    return text;
}

std::string box_plot(const MeasureResult& measure) {
    plot::StripPlot strips;
    strips.title = measure.info.title;
    strips.unit = measure.info.unit;
    strips.left = 110.0;
    std::vector<const MeasureSample*> samples;
    for (const std::vector<MeasureSample>* all : {&measure.conditions, &measure.other_times})
        for (const MeasureSample& sample : *all)
            if (!sample.values.empty()) samples.push_back(&sample);
    double low = 0.0, high = 0.0;
    for (const MeasureSample* sample : samples) {
        plot::StripRow row;
        row.label = shortened(sample->name, 18);
        const double scale = measure.info.scale;
        for (const double value : sample->values) {
            row.values.push_back(value * scale);
            low = std::min(low, value * scale);
            high = std::max(high, value * scale);
        }
        row.low = sample->quartiles.low * scale;
        row.median = sample->quartiles.median * scale;
        row.high = sample->quartiles.high * scale;
        if (sample->name == name(ObservationTime::retention)) row.style = "mclamp";
        strips.rows.push_back(std::move(row));
    }
    strips.ticks = plot::covering_ticks(low, high > low ? high : low + 1.0, 5);
    return plot::figure("<h3>" + plot::escape(measure.info.title) + "</h3>", plot::draw(strips), "");
}

std::string box_plots(const Results& results) {
    std::string out = "<h2>Every value</h2>\n<div class=\"grid\">\n";
    for (const MeasureResult& measure : results.measures) {
        const bool any = std::any_of(measure.conditions.begin(), measure.conditions.end(),
                                     [](const MeasureSample& s) { return !s.values.empty(); });
        if (any || !measure.other_times.empty()) out += box_plot(measure);
    }
    return out +
           "</div>\n<p class=\"note\">A dot is a participant: the mean of its lessons in the condition. Box "
           "and line: quartiles and median of type 7 (linear interpolation), as in NumPy and R's quantile(); "
           "R's boxplot() draws hinges, which differ in small samples.</p>\n";
}

std::string test_text(const ComparisonResult& result) {
    if (result.n == 0) return "no participant with all values";
    if (result.friedman)
        return fmt::format("Friedman χ²({}) = {}, W = {}", result.friedman->conditions - 1,
                           plot::number(result.friedman->chi_squared, 2),
                           plot::number(result.friedman->kendall_w, 2));
    if (result.signed_rank)
        return fmt::format(
            "Wilcoxon W⁺ = {}, W⁻ = {}{}, r = {}", plot::number(result.signed_rank->positive, 1),
            plot::number(result.signed_rank->negative, 1),
            result.signed_rank->zeros > 0 ? fmt::format(" ({} equal)", result.signed_rank->zeros) : "",
            plot::number(result.signed_rank->rank_biserial, 2));
    return fmt::format("rank sum U = {}, r = {}", plot::number(result.rank_sum->u, 1),
                       plot::number(result.rank_sum->rank_biserial, 2));
}

// In English, else in the form's first language.
std::vector<std::string> shown_labels(const content::Questionnaire& form,
                                      const content::QuestionnaireItem& item) {
    const std::vector<std::string> labels = content::answer_labels(form, item, "en");
    return labels.empty() && !form.titles.empty()
               ? content::answer_labels(form, item, form.titles.begin()->first)
               : labels;
}

// Counts the answers to an item: each label with its number.
std::string answer_counts(const content::Questionnaire& form, const content::QuestionnaireItem& item,
                          const std::string& step, const StudyData& data) {
    const content::AnswerScale& scale = content::answer_scale_of(form, item);
    const std::vector<std::string> labels = shown_labels(form, item);
    std::string text;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const double answer = scale.low + scale.step * static_cast<double>(i);
        const auto n = std::count_if(data.participants.begin(), data.participants.end(),
                                     [&](const ParticipantState& state) {
                                         const auto answers = state.progress.answers.find(step);
                                         if (answers == state.progress.answers.end()) return false;
                                         const auto given = answers->second.find(item.id);
                                         return given != answers->second.end() && given->second == answer;
                                     });
        if (n > 0) text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", plot::escape(labels[i]), n);
    }
    return text;
}

// Counts of the answers to categorical items, with a label for each answer, of the forms before the lessons.
std::string participants_table(const content::Study& study, const StudyData& data) {
    std::string rows;
    for (std::size_t i = 0; i < study.forms.size(); ++i) {
        if (!study.forms[i].is_at(content::FormTime::before)) continue;
        const content::Questionnaire& form = study.questionnaires[i];
        for (const content::QuestionnaireItem& item : form.items) {
            const std::size_t answers = content::answer_count(content::answer_scale_of(form, item));
            if (shown_labels(form, item).size() != answers) continue;
            const std::string counts = answer_counts(form, item, "before/" + form.id, data);
            if (!counts.empty())
                put(rows, "<tr><td class=\"w\">{}</td><td class=\"w\">{}</td></tr>\n",
                    plot::escape(content::text_in(item.texts)), counts);
        }
    }
    if (rows.empty()) return {};
    return "<h2>About the participants</h2>\n<table><thead><tr><th>question</th><th>answers and their "
           "number</th></tr></thead><tbody>\n" +
           rows + "</tbody></table>\n";
}

std::string comparison_kind(const content::PlannedComparison& planned) {
    if (!planned.interaction.empty())
        return ", interaction of " + plot::escape(planned.factor + " and " + planned.interaction);
    return planned.retention ? ", retention test" : "";
}

std::string comparisons_table(const Results& results) {
    if (results.comparisons.empty()) return {};
    std::string out =
        "<h2>Planned comparisons</h2>\n<div class=\"scroll\"><table><thead><tr><th>measure</th><th>groups "
        "(median)</th><th class=\"n\">n</th><th class=\"n\">difference [95 %]</th><th>test</th><th "
        "class=\"n\">p</th><th class=\"n\">p (Holm)</th></tr></thead><tbody>\n";
    for (const ComparisonResult& result : results.comparisons) {
        std::string groups, difference = "–";
        for (const MeasureSample& group : result.groups)
            groups += fmt::format("{}{} <span class=\"of\">{}</span>", groups.empty() ? "" : ", ",
                                  plot::escape(group.name), shown(result.info, group.quartiles.median));
        if (result.shift && std::isfinite(result.shift->estimate)) {
            difference =
                plot::signed_number(result.shift->estimate * result.info.scale, result.info.decimals);
            if (result.shift->confidence >= high_shift_confidence)
                difference += fmt::format(" <span class=\"of\">[{}, {}]</span>",
                                          shown(result.info, result.shift->interval.low),
                                          shown(result.info, result.shift->interval.high));
        }
        put(out,
            "<tr><td class=\"w\">{}{}</td><td class=\"w\">{}</td><td class=\"n\">{}</td><td "
            "class=\"n\">{}</td><td class=\"w\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
            plot::escape(result.info.title), comparison_kind(*result.planned), groups, result.n, difference,
            test_text(result), p_text(result.p), p_text(result.p_holm));
    }
    return out +
           "</tbody></table></div>\n<p class=\"note\">Difference: Hodges and Lehmann's estimate, first group "
           "minus second, with the interval of the exact distribution where there are enough participants. "
           "r: rank-biserial correlation, −1 to 1. p: two-sided; exact for Wilcoxon, and below 100 "
           "participants for the rank sum; χ² distribution for Friedman. Interaction: the signed rank test "
           "of the differences "
           "of the differences. Holm's correction is for all rows. With five "
           "participants or fewer no signed rank test can fall below 0.05.</p>\n";
}

// Forms with items that were not answered, which therefore give no value.
std::string incomplete_table(const content::Study& study, const StudyData& data) {
    std::string rows;
    for (const IncompleteForm& form : incomplete_forms(study, data.participants)) {
        std::string items;
        if (!form.declined.empty()) items = fmt::format("{}", fmt::join(form.declined, ", "));
        if (!form.unanswered.empty())
            items += fmt::format("{}{} <span class=\"of\">not reached yet</span>", items.empty() ? "" : "; ",
                                 fmt::join(form.unanswered, ", "));
        put(rows,
            "<tr><td>{}</td><td class=\"w\">{} <span class=\"of\">{}</span></td><td "
            "class=\"w\">{}</td><td class=\"w\">{}</td></tr>\n",
            form.participant, plot::escape(form.form), form.step, items,
            form.scales.empty() ? "–" : plot::escape(fmt::format("{}", fmt::join(form.scales, ", "))));
    }
    if (rows.empty()) return {};
    return "<h2>Forms that were not answered completely</h2>\n<div "
           "class=\"scroll\"><table><thead><tr><th>participant"
           "</th><th>form</th><th>items without an answer</th><th>no value for</th></tr></thead><tbody>\n" +
           rows + "</tbody></table></div>\n";
}

std::string comments(const StudyData& data) {
    std::string rows;
    for (const ParticipantState& state : data.participants)
        if (!state.progress.comment.empty())
            put(rows, "<tr><td>{}</td><td class=\"w\">{}</td></tr>\n", state.participant,
                plot::escape(state.progress.comment));
    if (rows.empty()) return {};
    return "<h2>Comments</h2>\n<table><thead><tr><th>participant</th><th>comment</th></tr></thead><tbody>\n" +
           rows + "</tbody></table>\n";
}

}  // namespace

std::string results_page(const content::Study& study, const StudyData& data, const Results& results) {
    std::string body;
    put(body, "<p class=\"over\">Boltwright study</p>\n<h1>{}</h1>\n<p>{}.</p>\n",
        plot::escape(content::text_in(study.titles)), plot::escape(design_text(study)));
    body += simulated_banner(data) + facts(study, data);
    if (data.participants.empty()) body += "<p class=\"banner\">Nobody has taken part yet.</p>\n";
    body += participants_table(study, data) + description_table(results, false) +
            incomplete_table(study, data) + description_table(results, true) + definitions(results);
    if (!data.participants.empty()) {
        body += comparisons_table(results) + box_plots(results) + learning_curves(data);
        body += methods_text(study, data, results) + comments(data);
    }
    return plot::page(content::text_in(study.titles) + ": results", body);
}

}  // namespace bolt::study
