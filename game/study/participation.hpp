// Leads one participant through a study: the step that is due, and the entries that each answer and each
// lesson adds to the journal. It draws nothing; game/trainer shows the steps to a person, and
// game/study_results/simulate.hpp answers them without one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "content/studies/study.hpp"
#include "game/study/participants.hpp"
#include "game/study/progress.hpp"
#include "game/study_journal/journal.hpp"

namespace bolt::study {

// Returns the time in seconds since 1970-01-01 UTC.
using UnixClock = std::function<std::int64_t()>;
std::int64_t system_time();

// The participation of one person. The study that it is made with must outlive it.
class Participation {
  public:
    // Enrols a person as the next participant; fails as add_participant().
    static Result<Participation> enrol(const content::Study& study, const std::filesystem::path& folder,
                                       const std::string& person, bool simulated,
                                       UnixClock clock = system_time);
    // Continues at the step reached. `participant`: "P03". Fails if the plan was changed since the
    // participant began, unless `accept_change`.
    static Result<Participation> resume(const content::Study& study, const std::filesystem::path& folder,
                                        const std::string& participant, bool accept_change,
                                        UnixClock clock = system_time);

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
    // Undoes the agreement, until the step is completed.
    Status take_back(std::size_t statement);
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
    // Creates the folder for the session of the due step's lesson, and returns it. Nothing is recorded yet.
    Result<std::filesystem::path> make_lesson_folder();
    // Records that the lesson in that folder has begun. `why`: the reason for which an interrupted lesson
    // could not be continued and begins again; empty: there was none.
    Status record_begun(const std::filesystem::path& lesson, const std::string& why = {});
    // Records that the lesson in that folder continues the one of begun_lesson().
    Status record_continued(const std::filesystem::path& lesson);
    // Makes the folder and records that its lesson has begun.
    Result<std::filesystem::path> begin_lesson();
    // The folder of the due step's last lesson that was begun or continued, and not recorded as ended.
    [[nodiscard]] std::optional<std::filesystem::path> begun_lesson() const;
    // Records the measures of the lesson, which has ended, and completes the step. The step `training`
    // lasts until its time is used up, so there the lesson's time is added instead. A lesson that was ended
    // before its last step counts too; a low `joints_ok` shows it.
    Status end_lesson(const std::map<std::string, double>& measures);

    // s by which the clock is behind the last entry; 0: it is not. A clock that was set back since the last
    // visit would shift the day of the retention test.
    [[nodiscard]] double clock_behind() const;
    // Records that the entries later than now were made with a wrong clock: their steps count as done now.
    Status accept_clock();

    // s until the due step can be completed: of a break, or of the days until the retention test; 0: now.
    [[nodiscard]] double remaining_wait() const;

    // Deletes the participant's data. The number and the date of the withdrawal stay. The object must
    // not be used afterwards.
    Status withdraw();

    [[nodiscard]] std::size_t due_index() const { return due_step(steps_, progress_); }

    // The conditions in the participant's order.
    [[nodiscard]] const std::vector<std::size_t>& conditions() const { return conditions_; }

  private:
    static Result<Participation> start(const content::Study& study, Journal journal,
                                       std::filesystem::path folder, UnixClock clock);
    Participation(const content::Study& study, Journal journal, std::filesystem::path folder,
                  UnixClock clock);
    void update_progress();
    [[nodiscard]] double steady_now() const;
    Status append(std::vector<JournalEntry> entries);
    [[nodiscard]] const content::Questionnaire& due_form() const;

    const content::Study* study_;
    Journal journal_;
    std::filesystem::path folder_;
    std::string participant_;
    UnixClock clock_;
    std::vector<Step> steps_;
    Progress progress_;
    std::vector<std::size_t> conditions_;
    // s; a clock that is set back while the program runs must not lengthen a break
    mutable std::int64_t last_time_ = 0, set_back_ = 0;
};

}  // namespace bolt::study
