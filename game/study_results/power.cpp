#include <algorithm>
#include <cmath>

#include "engine/base/random.hpp"
#include "game/study_results/results.hpp"

namespace bolt::study {

namespace {

// A study of participants whose forms are answered, without lessons.
StudyData simulated_forms(const content::Study& study, const PowerOptions& options, Random& random) {
    std::vector<ParticipantState> states;
    for (std::size_t place = 0; place < options.participants; ++place) {
        ParticipantState state;
        state.conditions = content::conditions_of(study, place);
        state.steps = steps_of(study, state.conditions);
        state.progress.place = place;
        state.progress.simulated = true;
        const double trait = random.normal();
        for (const Step& step : state.steps) {
            if (step.kind != StudyStepKind::form) continue;
            const bool between = study.design.subjects == content::StudySubjects::between;
            const std::size_t condition = between ? state.conditions.front() : step.condition;
            if (condition == no_index) continue;
            const content::Questionnaire& form = study.questionnaires[step.form];
            const double effect = condition < options.effects.size() ? options.effects[condition] : 0.0;
            for (std::size_t item = 0; item < form.items.size(); ++item)
                state.progress.answers[step.id][form.items[item].id] =
                    simulated_answer(form, item, trait + effect + random.normal());
        }
        states.push_back(std::move(state));
    }
    return collect(study, std::move(states));
}

bool has_power(const content::Study& study, const content::PlannedComparison& comparison) {
    return !comparison.retention && comparison.times.empty() && study.form_of(comparison.measure) != nullptr;
}

}  // namespace

std::vector<const content::PlannedComparison*> without_power(const content::Study& study) {
    std::vector<const content::PlannedComparison*> left_out;
    for (const content::PlannedComparison& comparison : study.comparisons)
        if (!has_power(study, comparison)) left_out.push_back(&comparison);
    return left_out;
}

std::string comparison_text(const content::PlannedComparison& planned) {
    std::string groups;
    for (const content::ComparedGroup& group : planned.groups)
        groups += (groups.empty() ? "" : ", ") + group.name;
    std::string text = planned.measure + ": ";
    if (!planned.factor.empty()) text += planned.factor + " ";
    text += groups;
    if (!planned.interaction.empty()) text += ", interaction with " + planned.interaction;
    return planned.retention ? text + ", retention test" : text;
}

double simulated_answer(const content::Questionnaire& form, std::size_t item, double latent) {
    const content::AnswerScale& scale = content::answer_scale_of(form, form.items[item]);
    bool reversed = false;
    for (const content::QuestionnaireScale& one : form.scales)
        for (const content::ScaleItem& part : one.items)
            reversed = reversed || (part.item == item && part.reversed);
    const double middle = 0.5 * (scale.low + scale.high), third = (scale.high - scale.low) / 6.0;
    const double value = middle + third * (reversed ? -latent : latent);
    const double steps = std::round((value - scale.low) / scale.step);
    const auto highest = static_cast<double>(content::answer_count(scale) - 1);
    return scale.low + scale.step * std::clamp(steps, 0.0, highest);
}

std::vector<Power> simulate_power(const content::Study& study, const PowerOptions& options) {
    std::vector<Power> powers;
    std::vector<std::size_t> of_forms;
    for (std::size_t i = 0; i < study.comparisons.size(); ++i) {
        const content::PlannedComparison& comparison = study.comparisons[i];
        if (!has_power(study, comparison)) continue;
        powers.push_back({&comparison, 0.0});
        of_forms.push_back(i);
    }
    Random random(options.seed);
    for (std::size_t i = 0; i < options.studies; ++i) {
        const std::vector<ComparisonResult> results = compare(study, simulated_forms(study, options, random));
        for (std::size_t k = 0; k < powers.size(); ++k)
            if (results[of_forms[k]].p_holm < options.significance)
                powers[k].rate += 1.0 / static_cast<double>(options.studies);
    }
    return powers;
}

}  // namespace bolt::study
