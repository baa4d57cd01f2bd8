#include "game/study/participation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

bool begins_lesson(JournalKind kind) {
    return kind == JournalKind::lesson_begun || kind == JournalKind::lesson_continued;
}

}  // namespace

std::int64_t system_time() {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

Participation::Participation(const content::Study& study, Journal journal, fs::path folder, UnixClock clock)
    : study_(&study),
      journal_(std::move(journal)),
      folder_(std::move(folder)),
      participant_(folder_.filename().string()),
      clock_(std::move(clock)) {
    update_progress();
}

Result<Participation> Participation::start(const content::Study& study, Journal journal, fs::path folder,
                                           UnixClock clock) {
    Participation participation(study, std::move(journal), std::move(folder), std::move(clock));
    auto conditions = assigned_conditions(study, participation.progress_);
    if (!conditions) {
        Error error = conditions.error();
        error.file = participation.folder_.string();
        return fail(std::move(error));
    }
    participation.conditions_ = std::move(*conditions);
    participation.steps_ = steps_of(study, participation.conditions_);
    return participation;
}

// A participant whose language the plan does not have any more chooses again.
void Participation::update_progress() {
    progress_ = progress_of(journal_.entries(), journal_.simulated());
    const std::vector<std::string> readable = content::complete_languages(*study_);
    if (std::find(readable.begin(), readable.end(), progress_.language) != readable.end()) return;
    progress_.language.clear();
    progress_.done.erase("language");
}

Result<Participation> Participation::enrol(const content::Study& study, const fs::path& folder,
                                           const std::string& person, bool simulated, UnixClock clock) {
    BOLT_TRY_ASSIGN(const auto own, add_participant(study, folder, {person, simulated, clock()}));
    BOLT_TRY_ASSIGN(auto journal, Journal::open(own / journal_file_name));
    return start(study, std::move(journal), own, std::move(clock));
}

Result<Participation> Participation::resume(const content::Study& study, const fs::path& folder,
                                            const std::string& participant, bool accept_change,
                                            UnixClock clock) {
    BOLT_TRY_ASSIGN(const auto own, find_participant(folder, participant));
    auto journal = Journal::open(own / journal_file_name);
    if (!journal && journal.error().what == session::lock_is_taken)
        return fail(participant_error(own, participant + " is led by another program",
                                      "the end of that program, or another participant"));
    if (!journal) return fail(journal.error());
    BOLT_TRY_ASSIGN(auto participation, start(study, std::move(*journal), own, std::move(clock)));
    if (participation.progress_.checksum == study.checksum) return participation;
    if (!accept_change)
        return fail(participant_error(
            folder, fmt::format("the plan or a form was changed after {} began", participant),
            "the files as they were, or --accept-change, which records that this participant continues with "
            "the changed ones"));
    BOLT_TRY(participation.append(
        {{JournalKind::plan_changed, 0, {}, checksum_text(study.checksum), {}, std::nullopt}}));
    return participation;
}

const Step* Participation::due() const {
    const std::size_t index = due_step(steps_, progress_);
    return index < steps_.size() ? &steps_[index] : nullptr;
}

const std::string& Participation::text(const std::map<std::string, std::string>& texts) const {
    return content::text_in(texts, progress_.language);
}

Status Participation::append(std::vector<JournalEntry> entries) {
    const std::int64_t now = clock_();
    for (JournalEntry& entry : entries) entry.time = now;
    BOLT_TRY(journal_.append(entries));
    update_progress();
    return {};
}

const content::Questionnaire& Participation::due_form() const { return study_->questionnaires[due()->form]; }

Status Participation::choose_language(const std::string& language) {
    return append({{JournalKind::language, 0, {}, {}, language, std::nullopt}});
}

Status Participation::agree(std::size_t statement) {
    return append({{JournalKind::agreed, 0, due()->id, std::to_string(statement), {}, std::nullopt}});
}

Status Participation::take_back(std::size_t statement) {
    return append({{JournalKind::agreed, 0, due()->id, std::to_string(statement), {}, 0.0}});
}

bool Participation::agreed(std::size_t statement) const {
    const auto answers = progress_.answers.find("consent");
    return answers != progress_.answers.end() && answers->second.contains(std::to_string(statement));
}

Status Participation::answer(const std::string& item, std::optional<double> value) {
    BOLT_TRY(content::score(due_form(), {{item, value}}));  // rejects an unknown item or answer
    return append({{JournalKind::answered, 0, due()->id, item, {}, value}});
}

std::size_t Participation::first_unanswered() const {
    const std::vector<content::QuestionnaireItem>& items = due_form().items;
    const auto answers = progress_.answers.find(due()->id);
    std::size_t index = 0;
    if (answers == progress_.answers.end()) return index;
    while (index < items.size() && answers->second.contains(items[index].id)) ++index;
    return index;
}

Status Participation::comment(const std::string& text) {
    return append({{JournalKind::commented, 0, due()->id, {}, text, std::nullopt}});
}

Status Participation::complete() {
    const Step& step = *due();
    const auto incomplete = [&](std::string what, std::string expected) {
        return fail(participant_error(folder_, std::move(what), std::move(expected)));
    };
    if (step.kind == StudyStepKind::language && progress_.language.empty())
        return incomplete("no language was chosen", "one of the study's languages");
    if (step.kind == StudyStepKind::consent)
        for (std::size_t i = 0; i < study_->consent.at(progress_.language).size(); ++i)
            if (!agreed(i)) return incomplete("a statement is not agreed to", "agreement to all of them");
    if (step.kind == StudyStepKind::form && first_unanswered() < due_form().items.size())
        return incomplete("an item is not answered", "an answer, or the choice not to answer");
    if (is_lesson(step.kind)) {
        const bool trained =
            step.kind == StudyStepKind::training && progress_.training_seconds >= study_->training->duration;
        if (!trained) return incomplete("the lesson is not finished", "a lesson to its end");
    }
    if (remaining_wait() > 0.0)
        return incomplete("it is too early for this step", fmt::format("{:.0f} s later", remaining_wait()));
    return append({{JournalKind::step_done, 0, step.id, {}, {}, std::nullopt}});
}

const content::StudyLesson& Participation::lesson() const {
    const Step& step = *due();
    if (step.kind == StudyStepKind::training) return study_->training->lesson;
    if (step.kind == StudyStepKind::retention) return study_->retention->lesson;
    return study_->conditions[step.condition].lesson;
}

Result<fs::path> Participation::make_lesson_folder() {
    const Step& step = *due();
    if (const double wait = remaining_wait(); wait > 0.0)
        return fail(participant_error(folder_, "it is too early for this lesson",
                                      fmt::format("{:.0f} s later", wait)));
    // In the training each lesson has a folder of its own; otherwise the session of an interrupted lesson
    // stays beside the new one, under another name.
    std::size_t number = 1;
    for (const JournalEntry& entry : journal_.entries())
        number += begins_lesson(entry.kind) && entry.step == step.id;
    std::string name = step.id;
    std::replace(name.begin(), name.end(), '/', '-');
    if (number > 1) name += fmt::format("-{}", number);
    std::error_code problem;
    fs::create_directories(folder_ / name, problem);
    if (problem) return fail(participant_error(folder_ / name, "cannot be created: " + problem.message()));
    return folder_ / name;
}

Status Participation::record_begun(const fs::path& lesson, const std::string& why) {
    return append({{JournalKind::lesson_begun, 0, due()->id, why, lesson.filename().string(), std::nullopt}});
}

Status Participation::record_continued(const fs::path& lesson) {
    return append(
        {{JournalKind::lesson_continued, 0, due()->id, {}, lesson.filename().string(), std::nullopt}});
}

Result<fs::path> Participation::begin_lesson() {
    BOLT_TRY_ASSIGN(const auto lesson, make_lesson_folder());
    BOLT_TRY(record_begun(lesson));
    return lesson;
}

std::optional<fs::path> Participation::begun_lesson() const {
    const Step* step = due();
    if (step == nullptr) return std::nullopt;
    std::optional<fs::path> folder;
    for (const JournalEntry& entry : journal_.entries()) {
        if (entry.step != step->id) continue;
        if (begins_lesson(entry.kind)) folder = folder_ / entry.text;
        if (entry.kind == JournalKind::measured) folder.reset();
    }
    return folder;
}

Status Participation::end_lesson(const std::map<std::string, double>& measures) {
    const Step& step = *due();
    std::vector<JournalEntry> entries;
    for (const auto& [measure, value] : measures)
        entries.push_back({JournalKind::measured,
                           0,
                           step.id,
                           measure,
                           {},
                           std::isfinite(value) ? std::optional(value) : std::nullopt});
    const auto duration = measures.find("duration_s");
    const double trained = progress_.training_seconds + (duration == measures.end() ? 0.0 : duration->second);
    if (step.kind != StudyStepKind::training || trained >= study_->training->duration)
        entries.push_back({JournalKind::step_done, 0, step.id, {}, {}, std::nullopt});
    return append(std::move(entries));
}

double Participation::clock_behind() const {
    return std::max(0.0, static_cast<double>(progress_.latest - clock_()));
}

Status Participation::accept_clock() {
    const double behind = clock_behind();
    if (behind == 0.0) return {};
    return append({{JournalKind::clock_set_back, 0, {}, {}, {}, behind}});
}

// s since 1970-01-01 UTC, which never runs backwards while the program runs.
double Participation::steady_now() const {
    const std::int64_t now = clock_();
    if (now < last_time_) set_back_ += last_time_ - now;
    last_time_ = now;
    return static_cast<double>(now + set_back_);
}

double Participation::remaining_wait() const {
    const double now = steady_now();
    const std::size_t index = due_step(steps_, progress_);
    if (index == steps_.size()) return 0.0;
    const Step& step = steps_[index];
    if (step.kind == StudyStepKind::retention) {
        const auto due_time = retention_due(*study_, progress_);
        return due_time ? std::max(0.0, static_cast<double>(*due_time) - now) : 0.0;
    }
    if (step.kind != StudyStepKind::pause || index == 0) return 0.0;
    const auto before = progress_.done.find(steps_[index - 1].id);
    const double passed = before == progress_.done.end() ? 0.0 : now - static_cast<double>(before->second);
    return std::clamp(study_->design.shortest_break - std::max(passed, 0.0), 0.0,
                      study_->design.shortest_break);
}

Status Participation::withdraw() { return delete_participant(folder_, clock_()); }

}  // namespace bolt::study
