#include "content/questionnaires/questionnaire.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/format/json_document.hpp"

namespace bolt::content {

namespace {

constexpr double step_tolerance = 1e-6;  // of a step; decimal steps such as 0.1 are not exact

Status check_answers(const Questionnaire& questionnaire, const Answers& answers) {
    std::vector<std::string> ids;
    for (const QuestionnaireItem& item : questionnaire.items) ids.push_back(item.id);
    for (const auto& [id, answer] : answers) {
        const auto found = std::find(ids.begin(), ids.end(), id);
        if (found == ids.end())
            return fail(ErrorCode::bad_content,
                        fmt::format("{}: there is no item {}", questionnaire.id, in_quotes(id)),
                        suggest(id, ids));
        const auto index = static_cast<std::size_t>(found - ids.begin());
        const AnswerScale& scale = answer_scale_of(questionnaire, questionnaire.items[index]);
        if (answer && !is_answer(scale, *answer))
            return fail(
                ErrorCode::bad_content,
                fmt::format("{}: the answer to item {} is {}", questionnaire.id, in_quotes(id), *answer),
                fmt::format("a number from {} to {} in steps of {}", scale.low, scale.high, scale.step));
    }
    return {};
}

// None if the item is unanswered.
std::optional<double> part_of(const Questionnaire& questionnaire, const QuestionnaireScale& scale,
                              const ScaleItem& item, const Answers& answers) {
    const QuestionnaireItem& asked = questionnaire.items[item.item];
    const auto answer = answers.find(asked.id);
    if (answer == answers.end() || !answer->second) return std::nullopt;
    const AnswerScale& range = answer_scale_of(questionnaire, asked);
    const double part = item.reversed ? range.low + range.high - *answer->second : *answer->second;
    return scale.from_zero ? part - range.low : part;
}

// None if a part is missing.
std::optional<double> combine(const std::vector<std::optional<double>>& parts, Combination combination) {
    double sum = 0.0;
    for (const std::optional<double>& part : parts) {
        if (!part) return std::nullopt;
        sum += *part;
    }
    return combination == Combination::mean ? sum / static_cast<double>(parts.size()) : sum;
}

}  // namespace

const AnswerScale& answer_scale_of(const Questionnaire& questionnaire, const QuestionnaireItem& item) {
    return item.answer_scale ? *item.answer_scale : questionnaire.answer_scale;
}

std::vector<std::string> answer_labels(const Questionnaire& questionnaire, const QuestionnaireItem& item,
                                       const std::string& language) {
    const bool own = item.answer_scale || !item.labels.empty();
    const AnswerLabels& labels = own ? item.labels : questionnaire.answer_scale.labels;
    const auto found = labels.find(language);
    return found == labels.end() ? std::vector<std::string>{} : found->second;
}

const std::string& text_in(const std::map<std::string, std::string>& texts, const std::string& language) {
    static const std::string none;
    for (const std::string& code : {language, std::string("en")})
        if (const auto found = texts.find(code); found != texts.end()) return found->second;
    return texts.empty() ? none : texts.begin()->second;
}

bool is_answer(const AnswerScale& scale, double number) {
    const double steps = (number - scale.low) / scale.step;
    return number >= scale.low && number <= scale.high &&
           std::abs(steps - std::round(steps)) < step_tolerance;
}

std::size_t answer_count(const AnswerScale& scale) {
    return static_cast<std::size_t>(std::lround((scale.high - scale.low) / scale.step)) + 1;
}

std::vector<std::string> missing_texts(const Questionnaire& questionnaire, const std::string& language) {
    std::vector<std::string> missing;
    for (const QuestionnaireItem& item : questionnaire.items)
        if (!item.texts.contains(language)) missing.push_back(item.id);
    return missing;
}

std::optional<ScoreRange> score_range(const Questionnaire& questionnaire, const QuestionnaireScale& scale) {
    if (scale.items.empty() || !scale.scales.empty()) return std::nullopt;
    ScoreRange range;
    for (const ScaleItem& item : scale.items) {
        const AnswerScale& answers = answer_scale_of(questionnaire, questionnaire.items[item.item]);
        if (range.step > 0.0 && std::abs(answers.step - range.step) > step_tolerance) return std::nullopt;
        range.step = answers.step;
        range.low += scale.from_zero ? 0.0 : answers.low;
        range.high += scale.from_zero ? answers.high - answers.low : answers.high;
    }
    const double parts =
        scale.combination == Combination::mean ? static_cast<double>(scale.items.size()) : 1.0;
    for (double* value : {&range.low, &range.high, &range.step}) *value *= scale.weight / parts;
    return range;
}

Result<std::vector<ScaleScore>> score(const Questionnaire& questionnaire, const Answers& answers) {
    BOLT_TRY(check_answers(questionnaire, answers));
    std::vector<std::optional<double>> raw_values;
    std::vector<ScaleScore> scores;
    for (const QuestionnaireScale& scale : questionnaire.scales) {
        std::vector<std::optional<double>> parts;
        for (const ScaleItem& item : scale.items)
            parts.push_back(part_of(questionnaire, scale, item, answers));
        for (const std::size_t index : scale.scales) parts.push_back(raw_values[index]);
        const std::optional<double> raw = combine(parts, scale.combination);
        raw_values.push_back(raw);
        scores.push_back({scale.id, raw ? std::optional(scale.weight * *raw) : std::nullopt});
    }
    return scores;
}

}  // namespace bolt::content
