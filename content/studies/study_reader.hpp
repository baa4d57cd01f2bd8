// The state of reading a study, which the functions for its parts share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/format/reader.hpp"
#include "content/studies/study.hpp"

namespace bolt::content {

// A study while it is read.
struct StudyReader {
    JsonReader json;
    const std::vector<Questionnaire>* questionnaires;  // null: unknown
    Study study;
    std::vector<std::string> condition_ids;
    bool conditions_valid = false;  // false: an unknown condition may be the consequence of a mistake
};

// A whole number, which the schema has checked.
inline std::size_t whole(JsonReader& json, const JsonNode& object, const char* key, std::size_t fallback) {
    const std::optional<double> number = json.number(json.member(object, key));
    return number ? static_cast<std::size_t>(*number) : fallback;
}

inline bool boolean(JsonReader& json, const JsonNode& object, const char* key, bool fallback) {
    return json.boolean(json.member(object, key)).value_or(fallback);
}

// Reports settings of display, hand, glove and devices that contradict each other (check_lesson.cpp). `own`:
// the lesson's members, which replace those of the study's "lesson"; may be missing.
void check_lesson(JsonReader& json, const JsonNode& own, const StudyLesson& lesson);

// Read the planned comparisons and the published values (read_comparisons.cpp), after conditions and forms.
void read_comparisons(StudyReader& reader);
void read_published(StudyReader& reader);

}  // namespace bolt::content
