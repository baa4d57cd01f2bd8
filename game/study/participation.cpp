#include "game/study/participation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>

#include "engine/base/file.hpp"

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

constexpr double day = 86400.0;  // s

void add_forms(const content::Study& study, content::FormTime time, const std::string& prefix,
               const Step& like, std::vector<Step>& steps) {
    for (std::size_t i = 0; i < study.forms.size(); ++i) {
        if (!study.forms[i].is_at(time)) continue;
        Step step = like;
        step.kind = StepKind::form;
        step.form = i;
        step.id = prefix + study.forms[i].id;
        steps.push_back(std::move(step));
    }
}

void add_condition(const content::Study& study, std::size_t part, std::size_t condition,
                   std::vector<Step>& steps) {
    const std::string prefix = fmt::format("part-{}/", part + 1);
    Step step{StepKind::lesson, {}, no_index, part, condition, 0};
    for (std::size_t lesson = 0; lesson < study.design.sessions; ++lesson) {
        step.lesson = lesson;
        step.id = fmt::format("{}lesson-{}", prefix, lesson + 1);
        steps.push_back(step);
        add_forms(study, content::FormTime::after_session, step.id + "/", step, steps);
    }
    step.lesson = no_index;
    add_forms(study, content::FormTime::after_condition, prefix, step, steps);
}

bool is_lesson(StepKind kind) {
    return kind == StepKind::lesson || kind == StepKind::training || kind == StepKind::retention;
}

std::string checksum_text(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

Error participant_error(const fs::path& folder, std::string what, std::string expected = {}) {
    Error error;
    error.file = folder.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

// "P07" of a folder's name; 0: the folder is not a participant's.
std::size_t participant_number(const std::string& name) {
    if (name.size() < 3 || name[0] != 'P') return 0;
    std::size_t number = 0;
    for (const char c : name.substr(1)) {
        if (c < '0' || c > '9' || number > 100000) return 0;
        number = 10 * number + static_cast<std::size_t>(c - '0');
    }
    return number;
}

// The folders of participants, by number.
Result<std::map<std::size_t, fs::path>> participant_folders(const fs::path& participants) {
    std::map<std::size_t, fs::path> folders;
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(participants, problem))
        if (const std::size_t number = participant_number(entry.path().filename().string()); number > 0)
            folders.emplace(number, entry.path());
    if (problem) return fail(participant_error(participants, "cannot be read: " + problem.message()));
    return folders;
}

// Deletes everything in the folder of a participant but the mark, and what was computed from it. The mark
// comes first, so that an interrupted deletion can be completed.
Status delete_participant(const fs::path& folder, std::int64_t time) {
    std::error_code problem;
    if (!fs::exists(folder / withdrawn_file_name, problem)) BOLT_TRY(mark_withdrawn(folder, time));
    std::vector<std::string> left;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
        if (entry.path().filename() == withdrawn_file_name) continue;
        std::error_code failed;
        fs::remove_all(entry.path(), failed);
        if (failed) left.push_back(entry.path().string() + ": " + failed.message());
    }
    if (problem) left.push_back(folder.string() + ": " + problem.message());
    for (const fs::path& file : delete_derived_files(folder)) left.push_back(file.string());
    if (left.empty()) return {};
    return fail(
        participant_error(folder, fmt::format("not deleted: {}", fmt::join(left, "; ")), "deletion by hand"));
}

// True if something besides the mark and lock files is left.
bool has_leftovers(const fs::path& folder) {
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem))
        if (entry.path().filename() != withdrawn_file_name && entry.path().extension() != ".lock")
            return true;
    return false;
}

// Fails if the person or the plan do not fit to the participants who have begun.
Status check_enrolment(const content::Study& study, const fs::path& folder, const std::string& person,
                       bool simulated, const std::vector<ParticipantState>& states) {
    for (const ParticipantState& state : states) {
        if (state.withdrawn || state.problem) continue;
        if (state.progress.simulated != simulated)
            return fail(participant_error(folder, "people and simulated participants are never mixed",
                                          "a folder of their own"));
        if (state.progress.person == person)
            return fail(participant_error(folder, "this person takes part as " + state.participant,
                                          "--participant " + state.participant));
        if (state.progress.checksum != study.checksum)
            return fail(participant_error(
                folder, fmt::format("the plan or a form was changed after {} began", state.participant),
                "the files as they were, or `study run --participant " + state.participant +
                    " --accept-change` for each participant first"));
    }
    return {};
}

}  // namespace

std::int64_t system_time() {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

std::vector<Step> steps_of(const content::Study& study, const std::vector<std::size_t>& conditions) {
    using content::FormTime;
    std::vector<Step> steps{{StepKind::language, "language"},
                            {StepKind::information, "information"},
                            {StepKind::consent, "consent"}};
    add_forms(study, FormTime::before, "before/", {}, steps);
    if (study.training) {
        steps.push_back({StepKind::training, "training"});
        add_forms(study, FormTime::after_training, "training/", {}, steps);
    }
    for (std::size_t part = 0; part < conditions.size(); ++part) {
        if (part > 0) steps.push_back({StepKind::pause, fmt::format("break-{}", part), no_index, part});
        add_condition(study, part, conditions[part], steps);
    }
    add_forms(study, FormTime::after, "after/", {}, steps);
    steps.push_back({StepKind::comment, "comment"});
    if (study.retention) {
        steps.push_back({StepKind::end_of_visit, "end-of-visit"});
        steps.push_back({StepKind::retention, "retention"});
        add_forms(study, FormTime::retention, "retention/", {}, steps);
    }
    steps.push_back({StepKind::farewell, "farewell"});
    return steps;
}

Progress progress_of(std::span<const JournalEntry> entries, bool simulated) {
    Progress progress;
    progress.simulated = simulated;
    if (!entries.empty()) progress.begun = entries.front().time;
    std::set<std::string> open_lessons;
    for (const JournalEntry& entry : entries) {
        progress.latest = entry.time;
        switch (entry.kind) {
            case JournalKind::enrolled:
                progress.person = entry.text;
                progress.place = static_cast<std::size_t>(entry.value.value_or(0.0));
                progress.checksum = std::strtoull(entry.item.c_str(), nullptr, 16);
                break;
            case JournalKind::assigned:
                progress.conditions.push_back(entry.item);
                break;
            case JournalKind::plan_changed:
                ++progress.plan_changes;
                progress.checksum = std::strtoull(entry.item.c_str(), nullptr, 16);
                break;
            case JournalKind::language:
                progress.language = entry.text;
                break;
            case JournalKind::answered:
                progress.answers[entry.step][entry.item] = entry.value;
                break;
            case JournalKind::agreed:
                progress.answers[entry.step][entry.item] = 1.0;
                break;
            case JournalKind::commented:
                progress.comment = entry.text;
                break;
            case JournalKind::lesson_begun:
                if (!open_lessons.insert(entry.step).second) progress.interrupted.push_back(entry.step);
                progress.lesson_folders[entry.step] = entry.text;
                break;
            case JournalKind::measured:
                open_lessons.erase(entry.step);
                if (entry.value) progress.measures[entry.step][entry.item] = *entry.value;
                if (entry.step == "training" && entry.item == "duration_s")
                    progress.training += entry.value.value_or(0.0);
                break;
            case JournalKind::step_done:
                progress.done.emplace(entry.step, entry.time);
                break;
            case JournalKind::clock_set_back:
                progress.clock_set_back += entry.value.value_or(0.0);
                break;
        }
    }
    return progress;
}

std::size_t due_step(const std::vector<Step>& steps, const Progress& progress) {
    return static_cast<std::size_t>(
        std::find_if(steps.begin(), steps.end(),
                     [&](const Step& step) { return !progress.done.contains(step.id); }) -
        steps.begin());
}

Result<std::vector<std::size_t>> assigned_conditions(const content::Study& study, const Progress& progress) {
    std::vector<std::size_t> conditions;
    for (const std::string& id : progress.conditions) {
        const auto found = std::find_if(study.conditions.begin(), study.conditions.end(),
                                        [&](const content::StudyCondition& c) { return c.id == id; });
        if (found == study.conditions.end())
            return fail(
                ErrorCode::bad_content,
                fmt::format("the plan does not have condition \"{}\", which a participant was given", id),
                "a plan with this condition");
        conditions.push_back(static_cast<std::size_t>(found - study.conditions.begin()));
    }
    return conditions;
}

std::optional<std::int64_t> retention_due(const content::Study& study, const Progress& progress) {
    const auto visit = progress.done.find("end-of-visit");
    if (!study.retention || visit == progress.done.end()) return std::nullopt;
    const double days = study.retention->after_days;
    if (days < 1.0) return visit->second + static_cast<std::int64_t>(days * day);
    const auto end = static_cast<std::time_t>(visit->second);
    std::tm date{};
    localtime_r(&end, &date);
    date.tm_mday += static_cast<int>(std::floor(days));
    date.tm_hour = date.tm_min = date.tm_sec = 0;
    date.tm_isdst = -1;
    return mktime(&date);
}

Participation::Participation(const content::Study& study, Journal journal, fs::path folder, Clock clock)
    : study_(&study),
      journal_(std::move(journal)),
      folder_(std::move(folder)),
      participant_(folder_.filename().string()),
      clock_(std::move(clock)) {
    update_progress();
}

Result<Participation> Participation::start(const content::Study& study, Journal journal, fs::path folder,
                                           Clock clock) {
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
                                           const std::string& person, bool simulated, Clock clock) {
    const fs::path participants = folder / participants_folder_name;
    std::error_code problem;
    fs::create_directories(participants, problem);
    if (problem) return fail(participant_error(participants, "cannot be created: " + problem.message()));
    // Held until the journal exists, so that two programs do not take the same place.
    BOLT_TRY_ASSIGN(const auto lock, session::FileLock::acquire(participants / "enrolment", "enrolment"));
    BOLT_TRY_ASSIGN(const auto states, list_participants(study, folder));
    BOLT_TRY(check_enrolment(study, folder, person, simulated, states));
    std::set<std::size_t> places;
    for (const ParticipantState& state : states)
        if (!state.withdrawn && !state.problem) places.insert(state.progress.place);
    std::size_t place = 0;
    while (places.contains(place)) ++place;
    BOLT_TRY_ASSIGN(const auto folders, participant_folders(participants));
    const std::size_t highest = folders.empty() ? 0 : folders.rbegin()->first;
    const fs::path own = participants / fmt::format("P{:02}", highest + 1);
    if (!fs::create_directory(own, problem))
        return fail(participant_error(own, "cannot be created: " + problem.message()));
    const std::int64_t now = clock();
    std::vector<JournalEntry> first{
        {JournalKind::enrolled, now, {}, checksum_text(study.checksum), person, static_cast<double>(place)}};
    for (const std::size_t condition : content::conditions_of(study, place))
        first.push_back({JournalKind::assigned,
                         now,
                         fmt::format("part-{}", first.size()),
                         study.conditions[condition].id,
                         {},
                         std::nullopt});
    auto journal = Journal::create(own / journal_file_name, simulated, first);
    if (!journal) {
        fs::remove_all(own, problem);
        return fail(journal.error());
    }
    return start(study, std::move(*journal), own, std::move(clock));
}

Result<Participation> Participation::resume(const content::Study& study, const fs::path& folder,
                                            const std::string& participant, bool accept_change, Clock clock) {
    const fs::path own = folder / participants_folder_name / participant;
    std::error_code ignored;
    if (participant_number(participant) == 0 || !fs::exists(own, ignored))
        return fail(participant_error(own, "there is no such participant"));
    if (fs::exists(own / withdrawn_file_name, ignored))
        return fail(participant_error(own, "this participant has withdrawn the consent"));
    BOLT_TRY_ASSIGN(auto journal, Journal::open(own / journal_file_name));
    BOLT_TRY_ASSIGN(auto participation, start(study, std::move(journal), own, std::move(clock)));
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
    static const std::string none;
    const auto found = texts.find(progress_.language);
    if (found != texts.end()) return found->second;
    const auto english = texts.find("en");
    if (english != texts.end()) return english->second;
    return texts.empty() ? none : texts.begin()->second;
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
    if (step.kind == StepKind::language && progress_.language.empty())
        return incomplete("no language was chosen", "one of the study's languages");
    if (step.kind == StepKind::consent)
        for (std::size_t i = 0; i < study_->consent.at(progress_.language).size(); ++i)
            if (!agreed(i)) return incomplete("a statement is not agreed to", "agreement to all of them");
    if (step.kind == StepKind::form && first_unanswered() < due_form().items.size())
        return incomplete("an item is not answered", "an answer, or the choice not to answer");
    if (is_lesson(step.kind)) {
        const bool trained =
            step.kind == StepKind::training && progress_.training >= study_->training->duration;
        if (!trained) return incomplete("the lesson is not finished", "a lesson to its end");
    }
    if (wait() > 0.0)
        return incomplete("it is too early for this step", fmt::format("{:.0f} s later", wait()));
    return append({{JournalKind::step_done, 0, step.id, {}, {}, std::nullopt}});
}

const content::StudyLesson& Participation::lesson() const {
    const Step& step = *due();
    if (step.kind == StepKind::training) return study_->training->lesson;
    if (step.kind == StepKind::retention) return study_->retention->lesson;
    return study_->conditions[step.condition].lesson;
}

Result<fs::path> Participation::begin_lesson() {
    const Step& step = *due();
    if (wait() > 0.0) return fail(participant_error(folder_, "it is too early for this lesson"));
    // In the training each lesson has a folder of its own; otherwise the session of an interrupted lesson
    // stays beside the new one, under another name.
    std::size_t number = 1;
    for (const JournalEntry& entry : journal_.entries())
        number += entry.kind == JournalKind::lesson_begun && entry.step == step.id;
    std::string name = step.id;
    std::replace(name.begin(), name.end(), '/', '-');
    if (number > 1) name += fmt::format("-{}", number);
    std::error_code problem;
    fs::create_directories(folder_ / name, problem);
    if (problem) return fail(participant_error(folder_ / name, "cannot be created: " + problem.message()));
    BOLT_TRY(append({{JournalKind::lesson_begun, 0, step.id, {}, name, std::nullopt}}));
    return folder_ / name;
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
    const double trained = progress_.training + (duration == measures.end() ? 0.0 : duration->second);
    if (step.kind != StepKind::training || trained >= study_->training->duration)
        entries.push_back({JournalKind::step_done, 0, step.id, {}, {}, std::nullopt});
    return append(std::move(entries));
}

// s since 1970-01-01 UTC, which never runs backwards while the program runs.
double Participation::steady_now() const {
    const std::int64_t now = clock_();
    if (now < last_time_) set_back_ += last_time_ - now;
    last_time_ = now;
    return static_cast<double>(now + set_back_);
}

double Participation::wait() const {
    const double now = steady_now();
    const std::size_t index = due_step(steps_, progress_);
    if (index == steps_.size()) return 0.0;
    const Step& step = steps_[index];
    if (step.kind == StepKind::retention) {
        const auto due_time = retention_due(*study_, progress_);
        return due_time ? std::max(0.0, static_cast<double>(*due_time) - now) : 0.0;
    }
    if (step.kind != StepKind::pause || index == 0) return 0.0;
    const auto before = progress_.done.find(steps_[index - 1].id);
    const double passed = before == progress_.done.end() ? 0.0 : now - static_cast<double>(before->second);
    return std::clamp(study_->design.shortest_break - std::max(passed, 0.0), 0.0,
                      study_->design.shortest_break);
}

Status Participation::withdraw() { return delete_participant(folder_, clock_()); }

Status withdraw(const fs::path& study_folder, const std::string& participant, std::int64_t time) {
    const fs::path own = study_folder / participants_folder_name / participant;
    std::error_code ignored;
    if (participant_number(participant) == 0 || !fs::exists(own, ignored))
        return fail(participant_error(own, "there is no such participant"));
    if (fs::exists(own / withdrawn_file_name, ignored) && !has_leftovers(own))
        return fail(participant_error(own, "this participant has withdrawn the consent"));
    BOLT_TRY_ASSIGN(const auto lock,
                    session::FileLock::acquire(own / journal_file_name, (own / journal_file_name).string()));
    return delete_participant(own, time);
}

namespace {

ParticipantState read_state(const content::Study& study, const fs::path& folder) {
    ParticipantState state;
    state.participant = folder.filename().string();
    std::error_code ignored;
    state.withdrawn = fs::exists(folder / withdrawn_file_name, ignored);
    if (state.withdrawn) {
        if (has_leftovers(folder))
            state.problem = participant_error(folder, "the withdrawal was interrupted",
                                              "`study withdraw` for this participant again");
        return state;
    }
    const auto read = read_journal(folder / journal_file_name);
    if (!read) {
        state.problem = read.error();
        return state;
    }
    state.progress = progress_of(read->entries, read->simulated);
    auto conditions = assigned_conditions(study, state.progress);
    if (!conditions) {
        state.problem = conditions.error();
        state.problem->file = folder.string();
        return state;
    }
    state.conditions = std::move(*conditions);
    state.steps = steps_of(study, state.conditions);
    state.due = due_step(state.steps, state.progress);
    return state;
}

}  // namespace

Result<std::vector<ParticipantState>> list_participants(const content::Study& study, const fs::path& folder) {
    std::vector<ParticipantState> states;
    const fs::path participants = folder / participants_folder_name;
    std::error_code problem;
    if (!fs::exists(participants, problem)) return states;
    BOLT_TRY_ASSIGN(const auto folders, participant_folders(participants));
    for (const auto& [number, own] : folders) {
        // A program that was killed while it enrolled somebody leaves a folder without a journal.
        const bool begun =
            fs::exists(own / journal_file_name, problem) || fs::exists(own / withdrawn_file_name, problem);
        if (begun) states.push_back(read_state(study, own));
    }
    return states;
}

}  // namespace bolt::study
