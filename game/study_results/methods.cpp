#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/plot/html.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

using plot::put;

// "1 participant", "2 participants"
std::string count_text(std::size_t n, std::string_view noun) {
    return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

// "Once", "3 times"
std::string times_text(std::size_t n) { return n == 1 ? std::string("Once") : fmt::format("{} times", n); }

// "10.0 to 12.5", or one number
std::string span_text(std::vector<double> values, int decimals) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const std::string a = plot::number(*low, decimals), b = plot::number(*high, decimals);
    return a == b ? a : a + " to " + b;
}

void put_people(std::string& out, const StudyData& data) {
    put(out, "{}{} {} analysed; {} did every step. ", count_text(data.participants.size(), "participant"),
        data.simulated() ? " (simulated)" : "", data.participants.size() == 1 ? "is" : "are",
        data.completed());
    out += data.withdrawn == 0 ? "Nobody withdrew. "
                               : fmt::format("{} withdrew. ", count_text(data.withdrawn, "other"));
}

// The time in finished lessons, not the planned one.
void put_training(std::string& out, const content::Study& study, const StudyData& data) {
    if (!study.training) return;
    std::vector<double> minutes;
    for (const ParticipantState& state : data.participants)
        if (state.progress.training_seconds > 0.0) minutes.push_back(state.progress.training_seconds / 60.0);
    const std::string planned = plot::duration_text(study.training->duration);
    if (minutes.empty())
        put(out, "A training of {} before the first condition was planned; nobody has trained yet. ",
            planned);
    else if (data.simulated())
        put(out, "A training of {} before the first condition was counted without being played. ", planned);
    else
        put(out, "Before the first condition {} trained for {} min in lessons (planned: {}). ",
            count_text(minutes.size(), "participant"), span_text(minutes, 1), planned);
}

void put_lessons(std::string& out, const content::Study& study, const StudyData& data) {
    std::size_t played = 0;
    for (const ParticipantState& state : data.participants)
        for (const Step& step : state.steps)
            played += step.kind == StudyStepKind::lesson && state.progress.measures.contains(step.id);
    put(out, "{} of {} planned {} in the conditions {} played. ", played,
        data.participants.size() * study.design.lessons *
            (study.design.subjects == content::StudySubjects::between ? 1 : study.conditions.size()),
        played == 1 && data.participants.size() == 1 ? "lesson" : "lessons", played == 1 ? "was" : "were");
}

void put_interruptions(std::string& out, const StudyData& data) {
    const Interruptions all = interruptions_of(data);
    if (all.lessons == 0) {
        if (!data.simulated()) out += "No lesson was interrupted. ";
        return;
    }
    put(out, "{} {} interrupted. ", count_text(all.lessons, "lesson"), all.lessons == 1 ? "was" : "were");
    if (all.continued > 0)
        put(out,
            "{}, a lesson was continued at the point reached; its measures count all parts and not the time "
            "between them. ",
            times_text(all.continued));
    if (all.begun_again > 0)
        put(out, "{}, a lesson began again; only the last attempt counts. ", times_text(all.begun_again));
}

void put_retention(std::string& out, const content::Study& study, const StudyData& data) {
    if (!study.retention) return;
    std::vector<double> days;
    for (const ParticipantState& state : data.participants) {
        const auto visit = state.progress.done.find("end-of-visit"),
                   test = state.progress.done.find("retention");
        if (visit != state.progress.done.end() && test != state.progress.done.end())
            days.push_back(static_cast<double>(test->second - visit->second) / 86400.0);
    }
    const std::string planned = fmt::format("{:g} {}", study.retention->after_days,
                                            study.retention->after_days == 1.0 ? "day" : "days");
    if (days.empty())
        put(out, "A retention test after {} was planned; nobody has taken it yet. ", planned);
    else
        put(out,
            "A retention test without change of condition followed after {} days (planned: {}); {} of {} "
            "participants took it. ",
            span_text(days, 1), planned, days.size(), data.participants.size());
}

// "in the window (a, b) and in a headset (c)"; empty if the plan names no displays.
std::string displays_text(const content::Study& study) {
    if (!content::names_displays(study)) return {};
    std::vector<std::string> places;
    for (const auto& [display, place] :
         {std::pair("window", "in the window"), std::pair("headset", "in a headset"),
          std::pair("walls", "on projection walls")}) {
        std::vector<std::string> titles;
        for (const content::StudyCondition& condition : study.conditions)
            if (condition.lesson.display == display ||
                (condition.lesson.display.empty() && std::string_view(display) == "window"))
                titles.push_back(plot::escape(content::text_in(condition.titles)));
        if (!titles.empty()) places.push_back(fmt::format("{} ({})", place, fmt::join(titles, ", ")));
    }
    std::string text = places.front();
    for (std::size_t i = 1; i < places.size(); ++i)
        text += (i + 1 == places.size() ? " and " : ", ") + places[i];
    return text;
}

std::string planning_text(const content::Study& study, const StudyData& data) {
    const std::string changed = changed_plans(data);
    const std::size_t n = study.comparisons.size();
    if (n == 0) return "No comparison was planned, so nothing was tested.";
    const std::string these = n == 1 ? "The comparison was" : fmt::format("The {} comparisons were", n);
    if (changed.empty()) return these + " planned before the first participant.";
    return fmt::format(
        "The plan was changed after participants had begun ({}), so it is not certain that {} planned "
        "before the data were seen.",
        changed, n == 1 ? "the comparison was" : fmt::format("the {} comparisons were", n));
}

// Only the tests that the results contain.
void put_tests(std::string& out, const Results& results) {
    std::vector<std::string> tests, effects;
    const auto any = [&](const auto& has) {
        return std::any_of(results.comparisons.begin(), results.comparisons.end(), has);
    };
    const auto related = [](const ComparisonResult& r) { return r.signed_rank.has_value(); };
    if (any(related))
        tests.emplace_back(
            "two related samples were compared by Wilcoxon's signed rank test (exact, zero "
            "differences dropped, midranks for ties)");
    if (any([](const ComparisonResult& r) { return !r.planned->interaction.empty(); }))
        tests.emplace_back(
            "interactions of two factors by the same test of each participant's difference of differences");
    if (any([](const ComparisonResult& r) { return r.friedman.has_value(); }))
        tests.emplace_back("more than two related samples were compared by Friedman's test");
    const auto independent = [](const ComparisonResult& r) { return r.rank_sum.has_value(); };
    if (any(independent))
        tests.emplace_back("independent samples were compared by the rank sum test (exact below 100 values)");
    if (tests.empty()) return;
    std::string text = fmt::format("{}", fmt::join(tests, "; "));
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    out += " " + text + ". All tests are two-sided";
    if (results.comparisons.size() > 1) out += ", with Holm's correction";
    out += ".";
    if (any(related) || any(independent)) effects.emplace_back("the rank-biserial correlation");
    if (any([](const ComparisonResult& r) { return r.friedman.has_value(); }))
        effects.emplace_back("Kendall's W");
    put(out, " Effect sizes: {}", fmt::join(effects, " and "));
    out += any(related) || any(independent) ? "; differences are Hodges and Lehmann's estimates." : ".";
}

}  // namespace

std::string design_text(const content::Study& study) {
    const content::StudyDesign& design = study.design;
    const std::size_t n = study.conditions.size();
    if (n == 1) return "one condition";
    if (design.subjects == content::StudySubjects::between)
        return fmt::format("{} groups of different participants, assigned by permuted blocks of {} (seed {})",
                           n, n, design.seed);
    if (design.order == content::StudyOrder::williams)
        return fmt::format("{} conditions within subjects, in the orders of a Williams square (seed {})", n,
                           design.seed);
    return fmt::format(
        "{} conditions within subjects, in random orders that are balanced in every {} participants (seed "
        "{})",
        n, n, design.seed);
}

Interruptions interruptions_of(const StudyData& data) {
    Interruptions all;
    for (const ParticipantState& state : data.participants) {
        const Progress& progress = state.progress;
        all.lessons += progress.interrupted_lessons;
        all.continued += progress.continued.size();
        all.begun_again += progress.begun_again.size();
    }
    return all;
}

std::string changed_plans(const StudyData& data) {
    std::string text;
    for (const ParticipantState& state : data.participants)
        if (state.progress.plan_changes > 0) text += (text.empty() ? "" : ", ") + state.participant;
    return text;
}

std::string methods_text(const content::Study& study, const StudyData& data, const Results& results) {
    std::string out = "<h2>Methods</h2>\n<p>";
    put_people(out, data);
    put(out, "The design had {}. ", design_text(study));
    if (const std::string displays = displays_text(study); !displays.empty())
        put(out, "The scene was shown {}. ", displays);
    put_training(out, study, data);
    put_lessons(out, study, data);
    put_interruptions(out, data);
    if (study.design.blind) out += "The experimenter did not see the conditions. ";
    put_retention(out, study, data);
    for (std::size_t i = 0; i < study.questionnaires.size(); ++i)
        put(out, "{}{} ({})", i == 0 ? "Forms: " : "; ",
            plot::escape(content::text_in(study.questionnaires[i].titles)),
            plot::escape(study.questionnaires[i].source));
    if (!study.questionnaires.empty()) out += ". ";
    put(out,
        "Samples are described by median and quartiles (type 7) and by the mean with a percentile "
        "bootstrap interval of 95 % ({} resamples, seed {}). {}",
        results.bootstrap.resamples, results.bootstrap.seed, planning_text(study, data));
    put_tests(out, results);
    return out + " Analysed with Boltwright.</p>\n";
}

}  // namespace bolt::study
