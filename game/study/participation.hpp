// Leads one participant through a study: the steps that follow from the plan, the step that is due, and what
// each answer and each lesson adds to the journal. It draws nothing; game/trainer shows the steps to a
// person, and simulate.hpp answers them without one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content/studies/study.hpp"
#include "game/study_journal/journal.hpp"

namespace bolt::study {

enum class StepKind : std::uint8_t {
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

inline constexpr std::size_t no_index = std::numeric_limits<std::size_t>::max();

struct Step {
    StepKind kind = StepKind::information;
    std::string id;                    // unique in the study: "part-2/lesson-1"
    std::size_t form = no_index;       // index into Study::forms
    std::size_t part = no_index;       // counts the participant's conditions from 0; none outside of them
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
    std::map<std::string, std::int64_t> done;                       // steps, with their time
    std::map<std::string, content::Answers> answers;                // by step
    std::map<std::string, std::map<std::string, double>> measures;  // of lessons, by step
    std::map<std::string, std::string> lesson_folders;              // by step; relative
    std::vector<std::string> interrupted;                           // steps whose lesson was begun again
    std::string comment;
    double training = 0.0;               // s in finished lessons of the training
    std::int64_t begun = 0, latest = 0;  // s since 1970-01-01 UTC
    double clock_set_back = 0.0;         // s in total
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

// Returns the time in seconds since 1970-01-01 UTC.
using Clock = std::function<std::int64_t()>;
std::int64_t system_time();

// The study that it is made with must outlive it.
class Participation {
  public:  // Enrols a person as the next participant: makes the folder PARTICIPANTS/Pnn and its journal.
           // Takes the
    // smallest place that no active participant has. Fails if the person takes part already, if active
    // participants follow another plan, or if people and simulated participants would be mixed. Two programs
    // may enrol at once.
    static Result<Participation> enrol(const content::Study& study, const std::filesystem::path& folder,
                                       const std::string& person, bool simulated, Clock clock = system_time);
    // Continues at the step reached. `participant`: "P03". Fails if the plan was changed since the
    // participant began, unless `accept_change`.
    static Result<Participation> resume(const content::Study& study, const std::filesystem::path& folder,
                                        const std::string& participant, bool accept_change,
                                        Clock clock = system_time);

    [[nodiscard]] const content::Study& study() const { return *study_; }
    [[nodiscard]] const std::string& participant() const { return participant_; }
    [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
    [[nodiscard]] const Progress& progress() const { return progress_; }
    // The due step; null if all are done.
    [[nodiscard]] const Step* due() const;
    // Text in the participant's language.
    [[nodiscard]] const std::string& text(const std::map<std::string, std::string>& texts) const;

    // Each of these is on the disk when it returns without an error; after an error nothing has changed.
    Status choose_language(const std::string& language);
    Status agree(std::size_t statement);
    [[nodiscard]] bool agreed(std::size_t statement) const;
    // `item` of the due form. None: the participant does not want to answer it.
    Status answer(const std::string& item, std::optional<double> value);
    // The first item of the due form without an answer; the number of items if there is none.
    [[nodiscard]] std::size_t first_unanswered() const;
    Status comment(const std::string& text);
    // Completes the due step. Fails if something of it is missing: an answer, an agreement, a lesson, or
    // the rest of the break or of the days until the retention test.
    Status complete();

    // The settings of the lesson. The due step must have one.
    [[nodiscard]] const content::StudyLesson& lesson() const;
    // Returns the folder for the session of the due step's lesson.
    Result<std::filesystem::path> begin_lesson();
    // Records the measures of the lesson, which has ended, and completes the step, or in the training
    // counts the lesson's time. A lesson that was ended before its last step counts too; a low `joints_ok`
    // shows it.
    Status end_lesson(const std::map<std::string, double>& measures);

    // s until the due step can be completed: of a break, or of the days until the retention test; 0: now.
    [[nodiscard]] double wait() const;

    // Deletes the participant's data. The number and the date of the withdrawal stay. The object must
    // not be used afterwards.
    Status withdraw();

    // The conditions in the participant's order.
    [[nodiscard]] const std::vector<std::size_t>& conditions() const { return conditions_; }

  private:
    static Result<Participation> start(const content::Study& study, Journal journal,
                                       std::filesystem::path folder, Clock clock);
    Participation(const content::Study& study, Journal journal, std::filesystem::path folder, Clock clock);
    void update_progress();
    [[nodiscard]] double steady_now() const;
    Status append(std::vector<JournalEntry> entries);
    [[nodiscard]] const content::Questionnaire& due_form() const;

    const content::Study* study_;
    Journal journal_;
    std::filesystem::path folder_;
    std::string participant_;
    Clock clock_;
    std::vector<Step> steps_;
    Progress progress_;
    std::vector<std::size_t> conditions_;
    // s; a clock that is set back while the program runs must not lengthen a break
    mutable std::int64_t last_time_ = 0, set_back_ = 0;
};

// Deletes the data of a participant whom no program leads. Completes an earlier withdrawal that was
// interrupted.
Status withdraw(const std::filesystem::path& study_folder, const std::string& participant, std::int64_t time);

// A participant as the experimenter sees it.
struct ParticipantState {
    std::string participant;  // "P03"
    bool withdrawn = false;
    Progress progress;
    std::vector<std::size_t> conditions;  // in the participant's order
    std::vector<Step> steps;              // none if withdrawn
    std::optional<Error> problem;         // the journal cannot be used, or a withdrawal is not complete
    std::size_t due = 0;                  // index into `steps`; their number: complete
};
// All participants of a study's folder, in the order of their numbers.
Result<std::vector<ParticipantState>> list_participants(const content::Study& study,
                                                        const std::filesystem::path& folder);

inline constexpr const char* participants_folder_name = "participants";
}  // namespace bolt::study
