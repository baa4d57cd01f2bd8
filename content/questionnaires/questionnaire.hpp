// Reads questionnaires and scores their answers. A questionnaire is a JSON file, whose members
// content/schema/questionnaire.schema.json describes:
//
//   {"format": "boltwright questionnaire 1", "id": "comfort", "title": {"en": "Comfort"}, "source": "ours",
//    "licence": "free", "texts_may_be_shipped": true,
//    "answers": {"low": 1, "high": 5, "step": 1, "labels": {"en": ["never", "always"]}},
//    "items": [{"id": "1", "text": {"en": "I sat well."}}, {"id": "2", "text": {"en": "I was cold."}}],
//    "scales": [{"id": "comfort", "title": {"en": "Comfort"}, "items": ["1", "2"], "reversed": ["2"],
//                "from_zero": true, "combine": "sum", "weight": 12.5}]}
//
// The score of a scale, from the answers x of its items:
//
//   part      = x, or low + high − x if the scale reverses the item; minus low with from_zero. low and high
//               are the item's own, if it has any
//   raw value = the sum or the mean of the parts
//   score     = weight · raw value
//
// The parts of a scale of scales are the raw values of these scales.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

// By language: two labels, of the lowest and the highest answer, or one for each answer. May be empty.
using AnswerLabels = std::map<std::string, std::vector<std::string>>;

// The answers low, low + step, ..., high.
struct AnswerScale {
    double low = 0.0;
    double high = 1.0;
    double step = 1.0;
    AnswerLabels labels;
};

struct QuestionnaireItem {
    std::string id;                            // answers are stored under it
    std::map<std::string, std::string> texts;  // by language; empty if only the scoring may be shipped
    AnswerLabels labels;                       // empty: those of the answer scale
    std::optional<AnswerScale> answer_scale;   // without labels; none: that of the questionnaire
};

struct ScaleItem {
    std::size_t item = 0;  // index into Questionnaire::items
    bool reversed = false;
};

enum class Combination : std::uint8_t { sum, mean };

// Has either items or scales.
struct QuestionnaireScale {
    std::string id;
    std::map<std::string, std::string> titles;  // by language
    std::vector<ScaleItem> items;
    std::vector<std::size_t> scales;  // indices into Questionnaire::scales, all less than its own
    bool from_zero = false;
    Combination combination = Combination::sum;
    double weight = 1.0;
};

struct Questionnaire {
    std::string id;
    std::map<std::string, std::string> titles;  // by language
    std::string source;
    std::string licence;
    bool texts_may_be_shipped = false;  // false: the laboratory adds the texts to its own copy
    AnswerScale answer_scale;
    std::vector<QuestionnaireItem> items;  // in the order in which they are presented
    std::vector<QuestionnaireScale> scales;
};

// A questionnaire without mistakes, or all mistakes of the file in its order, each with
// ErrorCode::bad_content, file, line, column and JSON pointer.
struct LoadedQuestionnaire {
    Questionnaire questionnaire;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is used in messages.
LoadedQuestionnaire parse_questionnaire(std::string_view text, const std::string& file);
LoadedQuestionnaire load_questionnaire(const std::filesystem::path& path);

// The text in a language, else in English, else in the first language; empty without texts.
const std::string& text_in(const std::map<std::string, std::string>& texts,
                           const std::string& language = "en");

// True if the number is one of the answers of the scale.
bool is_answer(const AnswerScale& scale, double number);

// The functions below need a questionnaire without mistakes.

// The answers to choose from, and their labels: two, one for each answer, or none in this language.
const AnswerScale& answer_scale_of(const Questionnaire& questionnaire, const QuestionnaireItem& item);
std::vector<std::string> answer_labels(const Questionnaire& questionnaire, const QuestionnaireItem& item,
                                       const std::string& language);

// The number of answers to choose from, at least 2.
std::size_t answer_count(const AnswerScale& scale);

// The ids of the items that have no text in the language, in the order of the items.
std::vector<std::string> missing_texts(const Questionnaire& questionnaire, const std::string& language);

// The scores that a scale of items can have: low, low + step, ..., high.
struct ScoreRange {
    double low = 0.0, high = 0.0, step = 0.0;
};
// None for a scale of scales, and for items with different steps.
std::optional<ScoreRange> score_range(const Questionnaire& questionnaire, const QuestionnaireScale& scale);

// By id of the item. An absent item and one without a value are unanswered.
using Answers = std::map<std::string, std::optional<double>>;

struct ScaleScore {
    std::string scale;            // id
    std::optional<double> score;  // none if an item of the scale is unanswered
    bool operator==(const ScaleScore&) const = default;
};

// The scores in the order of the questionnaire's scales. Fails if an answer is not on the answer scale or
// belongs to no item.
Result<std::vector<ScaleScore>> score(const Questionnaire& questionnaire, const Answers& answers);

}  // namespace bolt::content
