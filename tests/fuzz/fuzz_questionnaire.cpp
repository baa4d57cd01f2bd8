// Questionnaires: any bytes give a questionnaire whose lowest and highest answers have finite scores, or
// errors with positions, never a crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/questionnaires/questionnaire.hpp"

namespace {

using namespace bolt::content;

void expect(bool condition) {
    if (!condition) std::abort();
}

void check_scores(const Questionnaire& questionnaire, const Answers& answers, bool all_answered) {
    const auto scores = score(questionnaire, answers);
    expect(scores && scores->size() == questionnaire.scales.size());
    for (const ScaleScore& scale : *scores)
        expect(scale.score.has_value() == all_answered && std::isfinite(scale.score.value_or(0.0)));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const LoadedQuestionnaire read = parse_questionnaire(text, "fuzz.json");
    for (const bolt::Error& error : read.errors) expect(error.line >= 1 && !error.what.empty());
    if (!read.ok()) return 0;
    const Questionnaire& questionnaire = read.questionnaire;
    expect(!questionnaire.items.empty() && !questionnaire.scales.empty());
    for (const QuestionnaireItem& item : questionnaire.items) {
        const std::size_t count = answer_count(answer_scale_of(questionnaire, item));
        expect(count >= 2);
        for (const auto& [language, labels] : item.labels)
            expect(labels.size() == 2 || labels.size() == count);
        const std::size_t shown = answer_labels(questionnaire, item, "en").size();
        expect(shown == 0 || shown == 2 || shown == count);
    }
    for (const QuestionnaireScale& scale : questionnaire.scales)
        expect(scale.items.empty() != scale.scales.empty());
    Answers answers;
    check_scores(questionnaire, answers, false);
    for (const bool high : {false, true}) {
        for (const QuestionnaireItem& item : questionnaire.items) {
            const AnswerScale& range = answer_scale_of(questionnaire, item);
            answers[item.id] = high ? range.high : range.low;
        }
        expect(answers.size() == questionnaire.items.size());  // ids are unique
        check_scores(questionnaire, answers, true);
    }
    const QuestionnaireItem& first = questionnaire.items.front();
    const AnswerScale& range = answer_scale_of(questionnaire, first);
    answers[first.id] = range.high + range.step;
    expect(!score(questionnaire, answers));
    expect(missing_texts(questionnaire, "en").size() <= questionnaire.items.size());
    return 0;
}
