// The steps of a participant through a study, which follow from its plan, and the state that a journal
// records.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/studies/study.hpp"
#include "game/study_journal/journal.hpp"

namespace bolt::study {

enum class StudyStepKind : std::uint8_t {
    language,     // choice among the languages in which everything can be read
    information,  // a text to read
    consent,      // statements to agree to
    form,         // a questionnaire
    training,     // lessons until the training's time is used up
    lesson,       // one lesson of a condition
    pause,        // a break between two conditions, at least as long as the plan says
    comment,      // a text of the participant's own
    end_of_visit,
    retention,  // the lesson of the retention test, on a later day
    farewell,
};

// Returns true if a lesson is played in the step.
bool is_lesson(StudyStepKind kind);

inline constexpr std::size_t no_index = std::numeric_limits<std::size_t>::max();

struct Step {
    StudyStepKind kind = StudyStepKind::information;
    std::string id;               // unique in the study: "part-2/lesson-1"
    std::size_t form = no_index;  // index into Study::forms
    // Counts the participant's conditions from 0; of a break: the part after it; none outside of the parts.
    std::size_t part = no_index;
    std::size_t condition = no_index;  // index into Study::conditions
    std::size_t lesson = no_index;     // counts the lessons of a part from 0
};

// The steps of a participant with these conditions, in their order.
std::vector<Step> steps_of(const content::Study& study, const std::vector<std::size_t>& conditions);

// The state of a participant as a journal records it.
struct Progress {
    std::string person;  // code
    std::size_t place = 0;
    std::vector<std::string> conditions;  // ids, in the participant's order
    std::uint64_t checksum = 0;           // of the plan that the participant follows
    std::size_t plan_changes = 0;         // accepted since the participant began
    bool simulated = false;
    std::string language;
    // When each step was done, s since 1970-01-01 UTC. A time later than that of a following clock_set_back
    // entry is wrong, and is replaced by the time of that entry.
    std::map<std::string, std::int64_t> done;
    std::map<std::string, content::Answers> answers;                // by step
    std::map<std::string, std::map<std::string, double>> measures;  // of lessons, by step
    std::map<std::string, std::string> lesson_folders;              // by step; relative
    // Steps whose interrupted lesson began again, once for each time.
    std::vector<std::string> begun_again;
    // Steps whose interrupted lesson was continued at the point reached, once for each time.
    std::vector<std::string> continued;
    std::size_t interrupted_lessons = 0;  // each counted once
    std::string comment;
    double training_seconds = 0.0;                                // in finished lessons of the training
    std::vector<std::map<std::string, double>> training_lessons;  // the measures of each of them
    // Times of the first and of the last entry, s since 1970-01-01 UTC.
    std::int64_t begun = 0, latest = 0;
    double clock_set_back = 0.0;  // s in total
};
Progress progress_of(std::span<const JournalEntry> entries, bool simulated);

// The index of the first step that is not done; the number of steps if all are done.
std::size_t due_step(const std::vector<Step>& steps, const Progress& progress);

// The conditions that the participant was assigned at enrolment, as indices into the plan. Fails if the plan
// does not have one of them any more.
Result<std::vector<std::size_t>> assigned_conditions(const content::Study& study, const Progress& progress);

// The beginning of the first day, in local time, on which the retention test can be taken, s since 1970-01-01
// UTC. With fewer than one day between the visits, the exact time. None if the first visit is not complete.
std::optional<std::int64_t> retention_due(const content::Study& study, const Progress& progress);

}  // namespace bolt::study
