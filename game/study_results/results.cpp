#include "game/study_results/results.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/math.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

void add_scores(const content::Study& study, const ParticipantState& state, const Step& step,
                Observation common, StudyData& data) {
    const auto answers = state.progress.answers.find(step.id);
    if (answers == state.progress.answers.end()) return;
    const content::Questionnaire& form = study.questionnaires[step.form];
    const auto scores = content::score(form, answers->second);
    if (!scores) return;  // the form was changed since; the journal keeps the answers
    for (const content::ScaleScore& scale : *scores) {
        common.measure = form.id + "." + scale.scale;
        if (!scale.score) {
            data.without_score.emplace(common.measure, common.time);
            continue;
        }
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

// The lessons of the training. Those of a simulated participant are counted without being played.
void add_training(const ParticipantState& state, Observation common, StudyData& data) {
    if (state.progress.simulated) return;
    common.time = ObservationTime::training;
    for (std::size_t i = 0; i < state.progress.training_lessons.size(); ++i)
        for (const auto& [measure, value] : state.progress.training_lessons[i]) {
            common.lesson = i;
            common.measure = measure;
            common.value = value;
            data.observations.push_back(common);
        }
}

ObservationTime time_of(const Step& step) {
    if (step.kind == StudyStepKind::retention || step.id.starts_with("retention/"))
        return ObservationTime::retention;
    if (step.condition != no_index) return ObservationTime::condition;
    if (step.id.starts_with("before/")) return ObservationTime::before;
    return step.id.starts_with("training/") ? ObservationTime::after_training : ObservationTime::after;
}

// The scores that one person can have in a scale of items; none if they are not evenly spaced.
std::optional<content::ScoreRange> scores_of(const content::Study& study, const std::string& measure) {
    const content::Questionnaire* form = study.form_of(measure);
    if (form == nullptr) return std::nullopt;
    for (const content::QuestionnaireScale& scale : form->scales)
        if (form->id + "." + scale.id == measure) return content::score_range(*form, scale);
    return std::nullopt;
}

}  // namespace

MeasureSample sample_of(std::string name, const std::vector<double>& values,
                        const statistics::BootstrapOptions* bootstrap) {
    MeasureSample sample;
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

bool belongs_to_condition(const content::Study& study, const content::StudyForm& form) {
    return study.design.subjects == content::StudySubjects::between && form.is_at(content::FormTime::after) &&
           !form.is_at(content::FormTime::after_lesson) && !form.is_at(content::FormTime::after_condition);
}

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
            if (common.time == ObservationTime::after && step.form != no_index &&
                belongs_to_condition(study, study.forms[step.form]))
                common.time = ObservationTime::condition;
            common.part = step.part;
            common.lesson = step.lesson;
            if (step.kind == StudyStepKind::form) add_scores(study, state, step, common, data);
            if (step.kind == StudyStepKind::lesson || step.kind == StudyStepKind::retention)
                add_measures(state, step, common, data);
        }
        common.condition = common.part = no_index;
        add_training(state, common, data);
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
    constexpr std::string_view names[observation_times] = {"condition", "before",         "after training",
                                                           "after",     "retention test", "training"};
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
        for (const ObservationTime time :
             {ObservationTime::before, ObservationTime::after_training, ObservationTime::after,
              ObservationTime::retention, ObservationTime::training}) {
            MeasureSample sample =
                sample_of(std::string(name(time)), participant_means(data, {info.id, time}), &bootstrap);
            if (!sample.values.empty() || data.without_score.contains({info.id, time}))
                measure.other_times.push_back(std::move(sample));
        }
        for (const content::PublishedValue& published : study.published)
            if (published.measure == info.id) {
                measure.published = &published;
                if (const auto scores = scores_of(study, info.id))
                    measure.published_is_possible = statistics::is_possible_mean(
                        published.mean, published.decimals, published.n, scores->step, scores->low);
            }
        if (any || !measure.other_times.empty() || measure.published != nullptr)
            results.measures.push_back(std::move(measure));
    }
    results.comparisons = compare(study, data);
    return results;
}

}  // namespace bolt::study
