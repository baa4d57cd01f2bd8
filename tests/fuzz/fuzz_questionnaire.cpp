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
    const AnswerScale& range = questionnaire.answer_scale;
    const std::size_t count = answer_count(range);
    expect(count >= 2 && !questionnaire.items.empty() && !questionnaire.scales.empty());
    for (const auto& [language, labels] : range.labels) expect(labels.size() == 2 || labels.size() == count);
    for (const QuestionnaireScale& scale : questionnaire.scales)
        expect(scale.items.empty() != scale.scales.empty());
    Answers answers;
    check_scores(questionnaire, answers, false);
    for (const double answer : {range.low, range.high}) {
        for (const QuestionnaireItem& item : questionnaire.items) answers[item.id] = answer;
        expect(answers.size() == questionnaire.items.size());  // ids are unique
        check_scores(questionnaire, answers, true);
    }
    answers.begin()->second = range.high + range.step;
    expect(!score(questionnaire, answers));
    expect(missing_texts(questionnaire, "en").size() <= questionnaire.items.size());
    return 0;
}
