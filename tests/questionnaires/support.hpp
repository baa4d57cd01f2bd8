// The shipped questionnaires, and answers to them.
#pragma once

#include <doctest/doctest.h>

#include "content/format/folders.hpp"
#include "content/questionnaires/questionnaire.hpp"
#include "engine/base/file.hpp"

namespace questionnaire_test {

inline constexpr const char* shipped_ids[] = {"sus", "tlx", "ssq", "ipq", "paper", "background"};

inline std::filesystem::path shipped_file(const std::string& id) {
    return bolt::content::content_folder() / "questionnaires" / (id + ".json");
}

inline std::string shipped_text(const std::string& id) {
    const auto text = bolt::read_file(shipped_file(id), 1U << 20U, bolt::ErrorCode::failed);
    REQUIRE(text);
    return *text;
}

inline bolt::content::Questionnaire parsed(const std::string& text) {
    const auto loaded = bolt::content::parse_questionnaire(text, "q.json");
    for (const bolt::Error& error : loaded.errors) FAIL_CHECK(error.message());
    REQUIRE(loaded.ok());
    return loaded.questionnaire;
}

inline bolt::content::Questionnaire shipped(const std::string& id) { return parsed(shipped_text(id)); }

// The same answer to every item.
inline bolt::content::Answers all_answered(const bolt::content::Questionnaire& questionnaire, double answer) {
    bolt::content::Answers answers;
    for (const bolt::content::QuestionnaireItem& item : questionnaire.items) answers[item.id] = answer;
    return answers;
}

inline bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

}  // namespace questionnaire_test
