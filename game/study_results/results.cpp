#include "game/study_results/results.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/math.hpp"

namespace bolt::study {

namespace {

void add_scores(const content::Study& study, const ParticipantState& state, const Step& step,
                Observation common, StudyData& data) {
    const auto answers = state.progress.answers.find(step.id);
    if (answers == state.progress.answers.end()) return;
    const content::Questionnaire& form = study.questionnaires[step.form];
    const auto scores = content::score(form, answers->second);
    if (!scores) return;  // the form was changed since; the journal keeps the answers
    for (const content::ScaleScore& scale : *scores)
        if (scale.score) {
            common.measure = form.id + "." + scale.scale;
            common.value = *scale.score;
            data.observations.push_back(common);
        }
}

void add_measures(const ParticipantState& state, const Step& step, Observation common, StudyData& data) {
    const auto measures = state.progress.measures.find(step.id);
    if (measures == state.progress.measures.end()) return;
    for (const auto& [measure, value] : measures->second) {
        common.measure = measure;
        common.value = value;
        data.observations.push_back(common);
    }
}

ObservationTime time_of(const Step& step) {
    if (step.kind == StepKind::retention || step.id.starts_with("retention/"))
        return ObservationTime::retention;
    if (step.condition != no_index) return ObservationTime::condition;
    if (step.id.starts_with("before/")) return ObservationTime::before;
    return step.id.starts_with("training/") ? ObservationTime::after_training : ObservationTime::after;
}

Sample sample_of(std::string name, const std::vector<double>& values,
                 const statistics::BootstrapOptions* bootstrap) {
    Sample sample;
    sample.name = std::move(name);
    for (const double value : values)
        if (std::isfinite(value)) sample.values.push_back(value);
    sample.quartiles = statistics::quartiles(sample.values);
    sample.mean = sample.min = sample.max = nan;
    if (sample.values.empty()) return sample;
    const auto mean = [](std::span<const double> v) { return statistics::mean_deviation(v).mean; };
    sample.mean = mean(sample.values);
    const auto [low, high] = std::minmax_element(sample.values.begin(), sample.values.end());
    sample.min = *low;
    sample.max = *high;
    if (bootstrap != nullptr)
        sample.mean_interval = statistics::bootstrap_interval(sample.values, mean, *bootstrap);
    return sample;
}

// The scores that one person can have in a scale of one item: low, low + size, ...; size 0: unknown.
struct AnswerStep {
    double size = 0.0, low = 0.0;
};
AnswerStep answer_step(const content::Study& study, const std::string& measure) {
    const content::Questionnaire* form = study.form_of(measure);
    if (form == nullptr) return {};
    for (const content::QuestionnaireScale& scale : form->scales)
        if (form->id + "." + scale.id == measure && scale.items.size() == 1) {
            const content::AnswerScale& answers =
                content::answer_scale_of(*form, form->items[scale.items.front().item]);
            return {answers.step * scale.weight, scale.from_zero ? 0.0 : answers.low * scale.weight};
        }
    return {};
}

MeasureInfo info_of(const std::vector<MeasureInfo>& infos, const std::string& measure) {
    const auto found =
        std::find_if(infos.begin(), infos.end(), [&](const MeasureInfo& m) { return m.id == measure; });
    return found == infos.end() ? MeasureInfo{measure, measure} : *found;
}

// As participant_means(), but NaN unless the participant has every lesson, or the form after the part, of
// every condition: otherwise a mean over a factor's level would compare different conditions.
std::vector<double> complete_means(const content::Study& study, const StudyData& data,
                                   const Selection& selection) {
    std::vector<double> means = participant_means(data, selection);
    for (const std::size_t condition : selection.conditions) {
        std::vector<std::size_t> lessons(means.size(), 0), parts(means.size(), 0);
        for (const Observation& o : data.observations)
            if (o.measure == selection.measure && o.time == selection.time && o.condition == condition)
                ++(o.lesson == no_index ? parts : lessons)[o.participant];
        for (std::size_t i = 0; i < means.size(); ++i) {
            const bool complete = lessons[i] == study.design.lessons || (lessons[i] == 0 && parts[i] > 0);
            const bool once = selection.time == ObservationTime::retention && lessons[i] + parts[i] > 0;
            const bool required = study.design.subjects == content::StudySubjects::within;
            if (required && !complete && !once) means[i] = nan;
        }
    }
    return means;
}

// Participants with a finite value in every group: one row for each.
std::vector<std::vector<double>> complete_rows(const std::vector<std::vector<double>>& groups) {
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 0; i < groups.front().size(); ++i) {
        std::vector<double> row;
        for (const std::vector<double>& group : groups) row.push_back(group[i]);
        if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); }))
            rows.push_back(std::move(row));
    }
    return rows;
}

void test_within(const std::vector<std::vector<double>>& groups, ComparisonResult& result) {
    const std::vector<std::vector<double>> rows = complete_rows(groups);
    result.n = rows.size();
    if (groups.size() > 2) {
        result.friedman = statistics::friedman_test(rows);
        result.p = result.friedman->p;
        return;
    }
    std::vector<double> differences;
    for (const std::vector<double>& row : rows) differences.push_back(row[0] - row[1]);
    result.signed_rank = statistics::signed_rank_test(differences);
    result.shift = statistics::paired_shift(differences);
    result.p = result.signed_rank->p_two_sided;
}

void test_between(ComparisonResult& result) {
    const std::vector<double>&a = result.groups[0].values, &b = result.groups[1].values;
    result.n = a.size() + b.size();
    result.rank_sum = statistics::rank_sum_test(a, b);
    result.shift = statistics::independent_shift(a, b);
    result.p = result.rank_sum->p_two_sided;
}

}  // namespace

bool StudyData::simulated() const {
    return std::any_of(participants.begin(), participants.end(),
                       [](const ParticipantState& state) { return state.progress.simulated; });
}

std::size_t StudyData::completed() const {
    return static_cast<std::size_t>(
        std::count_if(participants.begin(), participants.end(),
                      [](const ParticipantState& state) { return state.due == state.steps.size(); }));
}

StudyData collect(const content::Study& study, std::vector<ParticipantState> states) {
    StudyData data;
    for (ParticipantState& state : states) {
        if (state.withdrawn) {
            ++data.withdrawn;
            continue;
        }
        Observation common;
        common.participant = data.participants.size();
        for (const Step& step : state.steps) {
            common.time = time_of(step);
            const bool between = study.design.subjects == content::StudySubjects::between;
            common.condition = between ? state.conditions.front() : step.condition;
            // Between subjects a form at the end belongs to the participant's only condition, unless the
            // form is presented in the condition too.
            if (between && common.time == ObservationTime::after && step.form != no_index &&
                !study.forms[step.form].is_at(content::FormTime::after_lesson) &&
                !study.forms[step.form].is_at(content::FormTime::after_condition))
                common.time = ObservationTime::condition;
            common.part = step.part;
            common.lesson = step.lesson;
            if (step.kind == StepKind::form) add_scores(study, state, step, common, data);
            if (step.kind == StepKind::lesson || step.kind == StepKind::retention)
                add_measures(state, step, common, data);
        }
        data.participants.push_back(std::move(state));
    }
    return data;
}

Result<StudyData> collect(const content::Study& study, const std::filesystem::path& folder) {
    BOLT_TRY_ASSIGN(auto states, list_participants(study, folder));
    for (const ParticipantState& state : states) {
        if (state.problem && !state.withdrawn) return fail(*state.problem);
        if (!state.withdrawn && state.progress.checksum != study.checksum) {
            Error error;
            error.file = folder.string();
            error.what = "the plan or a form was changed after " + state.participant + " began";
            error.expected = "the files as they were, or `study run --participant " + state.participant +
                             " --accept-change`";
            return fail(std::move(error));
        }
    }
    return collect(study, std::move(states));
}

std::string_view name(ObservationTime time) {
    constexpr std::string_view names[observation_times] = {"condition", "before", "after training", "after",
                                                           "retention test"};
    return names[static_cast<std::size_t>(time)];
}

std::vector<double> participant_means(const StudyData& data, const Selection& selection) {
    const std::vector<std::size_t>& conditions = selection.conditions;
    std::vector<double> sums(data.participants.size(), 0.0);
    std::vector<std::size_t> counts(data.participants.size(), 0);
    for (const Observation& o : data.observations) {
        if (o.measure != selection.measure || o.time != selection.time) continue;
        if (!conditions.empty() &&
            std::find(conditions.begin(), conditions.end(), o.condition) == conditions.end())
            continue;
        sums[o.participant] += o.value;
        ++counts[o.participant];
    }
    std::vector<double> means;
    for (std::size_t i = 0; i < sums.size(); ++i)
        means.push_back(counts[i] == 0 ? nan : sums[i] / static_cast<double>(counts[i]));
    return means;
}

std::vector<ComparisonResult> compare(const content::Study& study, const StudyData& data) {
    const std::vector<MeasureInfo> infos = measure_infos(study);
    std::vector<ComparisonResult> results;
    std::vector<double> p;
    for (const content::PlannedComparison& planned : study.comparisons) {
        ComparisonResult result;
        result.planned = &planned;
        result.info = info_of(infos, planned.measure);
        std::vector<std::vector<double>> groups;
        for (const content::ComparedGroup& group : planned.groups) {
            groups.push_back(complete_means(
                study, data,
                {planned.measure, planned.retention ? ObservationTime::retention : ObservationTime::condition,
                 group.conditions}));
            std::string name = group.name;
            if (planned.factor.empty())
                name = content::text_in(study.conditions[group.conditions.front()].titles);
            else
                name = planned.factor + " " + group.name;
            result.groups.push_back(sample_of(std::move(name), groups.back(), nullptr));
        }
        if (study.design.subjects == content::StudySubjects::within)
            test_within(groups, result);
        else
            test_between(result);
        p.push_back(result.p);
        results.push_back(std::move(result));
    }
    const std::vector<double> adjusted = statistics::holm(p);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].p_holm = adjusted[i];
    return results;
}

Results analyse(const content::Study& study, const StudyData& data,
                const statistics::BootstrapOptions& bootstrap) {
    Results results;
    results.bootstrap = bootstrap;
    for (const MeasureInfo& info : measure_infos(study)) {
        MeasureResult measure;
        measure.info = info;
        bool any = false;
        for (std::size_t i = 0; i < study.conditions.size(); ++i) {
            measure.conditions.push_back(
                sample_of(content::text_in(study.conditions[i].titles),
                          participant_means(data, {info.id, ObservationTime::condition, {i}}), &bootstrap));
            any = any || !measure.conditions.back().values.empty();
        }
        for (const ObservationTime time : {ObservationTime::before, ObservationTime::after_training,
                                           ObservationTime::after, ObservationTime::retention}) {
            Sample sample =
                sample_of(std::string(name(time)), participant_means(data, {info.id, time}), &bootstrap);
            if (!sample.values.empty()) measure.other_times.push_back(std::move(sample));
        }
        for (const content::PublishedValue& published : study.published)
            if (published.measure == info.id) {
                measure.published = &published;
                const AnswerStep step = answer_step(study, info.id);
                if (step.size > 0.0)
                    measure.published_is_possible = statistics::is_possible_mean(
                        published.mean, published.decimals, published.n, step.size, step.low);
            }
        if (any || !measure.other_times.empty() || measure.published != nullptr)
            results.measures.push_back(std::move(measure));
    }
    results.comparisons = compare(study, data);
    return results;
}

}  // namespace bolt::study
