// The tests of the planned comparisons.
#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"
#include "game/study_results/parts.hpp"

namespace bolt::study {

namespace {

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

// When a form that is presented at `time` gives its values: see collect().
ObservationTime observation_time(const content::Study& study, const std::string& measure,
                                 content::FormTime time) {
    switch (time) {
        case content::FormTime::before:
            return ObservationTime::before;
        case content::FormTime::after_training:
            return ObservationTime::after_training;
        case content::FormTime::retention:
            return ObservationTime::retention;
        default:
            break;
    }
    for (const content::StudyForm& form : study.forms)
        if (measure.starts_with(form.id + ".") && belongs_to_condition(study, form))
            return ObservationTime::condition;
    return ObservationTime::after;
}

// The values of each participant at two times.
void compare_times(const content::Study& study, const StudyData& data, ComparisonResult& result) {
    const content::PlannedComparison& planned = *result.planned;
    std::vector<std::vector<double>> groups;
    for (std::size_t i = 0; i < planned.times.size(); ++i) {
        const ObservationTime time = observation_time(study, planned.measure, planned.times[i]);
        groups.push_back(participant_means(data, {planned.measure, time, {}}));
        result.groups.push_back(sample_of(planned.groups[i].name, groups.back(), nullptr));
    }
    test_within(groups, result);
}

// The effect of the second factor at each level of the first one; the test is of their difference.
void compare_interaction(const content::Study& study, const StudyData& data, ComparisonResult& result) {
    const content::PlannedComparison& planned = *result.planned;
    const std::vector<content::ComparedGroup>& second = planned.interaction_groups;
    std::vector<std::vector<double>> effects;
    for (const content::ComparedGroup& first : planned.groups) {
        const auto cell = [&](const content::ComparedGroup& other) {
            return complete_means(
                study, data,
                {planned.measure, ObservationTime::condition, content::conditions_in_both(first, other)});
        };
        std::vector<double> effect = cell(second[0]);
        const std::vector<double> other = cell(second[1]);
        for (std::size_t i = 0; i < effect.size(); ++i) effect[i] -= other[i];
        result.groups.push_back(sample_of(planned.factor + " " + first.name + ": " + planned.interaction +
                                              " " + second[0].name + " − " + second[1].name,
                                          effect, nullptr));
        effects.push_back(std::move(effect));
    }
    test_within(effects, result);
}

void compare_groups(const content::Study& study, const StudyData& data, ComparisonResult& result) {
    const content::PlannedComparison& planned = *result.planned;
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
}

}  // namespace

std::vector<ComparisonResult> compare(const content::Study& study, const StudyData& data) {
    const std::vector<MeasureInfo> infos = measure_infos(study);
    std::vector<ComparisonResult> results;
    std::vector<double> p;
    for (const content::PlannedComparison& planned : study.comparisons) {
        ComparisonResult result;
        result.planned = &planned;
        result.info = info_of(infos, planned.measure);
        if (!planned.times.empty())
            compare_times(study, data, result);
        else if (!planned.interaction.empty())
            compare_interaction(study, data, result);
        else
            compare_groups(study, data, result);
        p.push_back(result.p);
        results.push_back(std::move(result));
    }
    const std::vector<double> adjusted = statistics::holm(p);
    for (std::size_t i = 0; i < results.size(); ++i) results[i].p_holm = adjusted[i];
    return results;
}

}  // namespace bolt::study
