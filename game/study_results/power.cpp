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
        state.steps = steps_of(study, place);
        state.progress.place = place;
        state.progress.simulated = true;
        const double trait = random.normal();
        for (const Step& step : state.steps) {
            if (step.kind != StepKind::form || step.condition == no_index) continue;
            const content::Questionnaire& form = study.questionnaires[step.form];
            const double effect =
                step.condition < options.effects.size() ? options.effects[step.condition] : 0.0;
            for (const content::QuestionnaireItem& item : form.items)
                state.progress.answers[step.id][item.id] =
                    simulated_answer(content::answer_scale_of(form, item), trait + effect + random.normal());
        }
        states.push_back(std::move(state));
    }
    return collect(study, std::move(states));
}

}  // namespace

double simulated_answer(const content::AnswerScale& scale, double latent) {
    const double middle = 0.5 * (scale.low + scale.high), third = (scale.high - scale.low) / 6.0;
    const double steps = std::round((middle + third * latent - scale.low) / scale.step);
    const auto highest = static_cast<double>(content::answer_count(scale) - 1);
    return scale.low + scale.step * std::clamp(steps, 0.0, highest);
}

std::vector<Power> simulate_power(const content::Study& study, const PowerOptions& options) {
    content::Study forms_only = study;
    std::erase_if(forms_only.comparisons, [&](const content::PlannedComparison& comparison) {
        return comparison.retention || study.form_of(comparison.measure) == nullptr;
    });
    std::vector<Power> powers;
    for (const content::PlannedComparison& comparison : study.comparisons)
        if (!comparison.retention && study.form_of(comparison.measure) != nullptr)
            powers.push_back({&comparison, 0.0});
    Random random(options.seed);
    for (std::size_t i = 0; i < options.studies; ++i) {
        const StudyData data = simulated_forms(forms_only, options, random);
        const std::vector<ComparisonResult> results = compare(forms_only, data);
        for (std::size_t k = 0; k < results.size(); ++k)
            if (results[k].p_holm < options.significance)
                powers[k].rate += 1.0 / static_cast<double>(options.studies);
    }
    return powers;
}

}  // namespace bolt::study
