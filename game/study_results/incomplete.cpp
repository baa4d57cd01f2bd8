// Forms with items that nobody answered.
#include <fmt/format.h>

#include "game/study_results/results.hpp"

namespace bolt::study {

namespace {

std::string items_text(const std::vector<std::string>& items, const char* what) {
    if (items.empty()) return {};
    return fmt::format("{} {} {}", items.size() == 1 ? "item" : "items", fmt::join(items, ", "), what);
}

}  // namespace

std::vector<IncompleteForm> incomplete_forms(const content::Study& study,
                                             const std::vector<ParticipantState>& states) {
    std::vector<IncompleteForm> incomplete;
    for (const ParticipantState& state : states)
        for (const Step& step : state.steps) {
            const auto answers = state.progress.answers.find(step.id);
            if (step.kind != StudyStepKind::form || answers == state.progress.answers.end()) continue;
            const content::Questionnaire& form = study.questionnaires[step.form];
            IncompleteForm one{state.participant, step.id, content::text_in(form.titles), {}, {}, {}};
            for (const content::QuestionnaireItem& item : form.items) {
                const auto answer = answers->second.find(item.id);
                if (answer == answers->second.end())
                    one.unanswered.push_back(item.id);
                else if (!answer->second)
                    one.declined.push_back(item.id);
            }
            if (one.declined.empty() && one.unanswered.empty()) continue;
            if (const auto scores = content::score(form, answers->second))
                for (std::size_t i = 0; i < scores->size(); ++i)
                    if (!(*scores)[i].score) one.scales.push_back(content::text_in(form.scales[i].titles));
            incomplete.push_back(std::move(one));
        }
    return incomplete;
}

std::string incomplete_text(const IncompleteForm& form) {
    std::string text = fmt::format("{} {}: {}", form.participant, form.step,
                                   items_text(form.declined, "not answered by choice"));
    if (!form.unanswered.empty())
        text += (form.declined.empty() ? "" : ", ") + items_text(form.unanswered, "not reached yet");
    return form.scales.empty() ? text
                               : fmt::format("{}, so there is no {}", text, fmt::join(form.scales, ", "));
}

}  // namespace bolt::study
