#include "game/study/participants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

// Returns the number in a folder name such as "P07"; 0: the folder is not a participant's.
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

// True if the folder has any entry except the withdrawal mark and lock files.
bool has_leftovers(const fs::path& folder) {
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem))
        if (entry.path().filename() != withdrawn_file_name && entry.path().extension() != ".lock")
            return true;
    return false;
}

// The participant is known and has not withdrawn. Participants whose journal cannot be read are not known.
bool is_active(const ParticipantState& state) { return !state.withdrawn && !state.progress.person.empty(); }

// Fails as add_participant() does.
Status check_enrolment(const content::Study& study, const fs::path& folder, const NewParticipant& participant,
                       const std::vector<ParticipantState>& states) {
    for (const ParticipantState& state : states) {
        if (!is_active(state)) continue;
        if (state.progress.simulated != participant.simulated)
            return fail(participant_error(folder, "people and simulated participants are never mixed",
                                          "a folder of their own"));
        if (state.progress.person == participant.person)
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

Error participant_error(const fs::path& folder, std::string what, std::string expected) {
    Error error;
    error.file = folder.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

std::string checksum_text(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

namespace {

// Locks the study against other enrolments. Waits up to three seconds for one that is in progress; it takes
// milliseconds.
Result<session::FileLock> lock_enrolments(const fs::path& participants) {
    constexpr int attempts = 150;
    constexpr std::chrono::milliseconds pause(20);
    for (int attempt = 1;; ++attempt) {
        auto lock = session::FileLock::acquire(participants / "enrolment", participants.string());
        const bool taken = !lock && lock.error().what == session::lock_is_taken;
        if (taken && attempt == attempts)
            return fail(participant_error(participants, "another program is enrolling a participant",
                                          "one enrolment at a time"));
        if (!taken) return lock;
        std::this_thread::sleep_for(pause);
    }
}

}  // namespace

Result<fs::path> add_participant(const content::Study& study, const fs::path& study_folder,
                                 const NewParticipant& participant) {
    const fs::path participants = study_folder / participants_folder_name;
    std::error_code problem;
    fs::create_directories(participants, problem);
    if (problem) return fail(participant_error(participants, "cannot be created: " + problem.message()));
    // Held until the journal exists, so that two programs do not take the same place.
    BOLT_TRY_ASSIGN(const auto lock, lock_enrolments(participants));
    BOLT_TRY_ASSIGN(const auto states, list_participants(study, study_folder));
    BOLT_TRY(check_enrolment(study, study_folder, participant, states));
    std::set<std::size_t> places;
    for (const ParticipantState& state : states)
        if (is_active(state)) places.insert(state.progress.place);
    std::size_t place = 0;
    while (places.contains(place)) ++place;
    BOLT_TRY_ASSIGN(const auto folders, participant_folders(participants));
    const std::size_t highest = folders.empty() ? 0 : folders.rbegin()->first;
    const fs::path own = participants / fmt::format("P{:02}", highest + 1);
    if (!fs::create_directory(own, problem))
        return fail(participant_error(own, "cannot be created: " + problem.message()));
    std::vector<JournalEntry> first{{JournalKind::enrolled,
                                     participant.time,
                                     {},
                                     checksum_text(study.checksum),
                                     participant.person,
                                     static_cast<double>(place)}};
    for (const std::size_t condition : content::conditions_of(study, place))
        first.push_back({JournalKind::assigned,
                         participant.time,
                         fmt::format("part-{}", first.size()),
                         study.conditions[condition].id,
                         {},
                         std::nullopt});
    const auto journal = Journal::create(own / journal_file_name, participant.simulated, first);
    if (!journal) {
        fs::remove_all(own, problem);
        return fail(journal.error());
    }
    return own;
}

Result<fs::path> find_participant(const fs::path& study_folder, const std::string& participant) {
    const fs::path own = study_folder / participants_folder_name / participant;
    std::error_code ignored;
    if (participant_number(participant) == 0 || !fs::exists(own, ignored))
        return fail(
            participant_error(own, "there is no such participant", "a folder in participants/, such as P03"));
    if (fs::exists(own / withdrawn_file_name, ignored))
        return fail(
            participant_error(own, "this participant has withdrawn the consent", "another participant"));
    return own;
}

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

Status withdraw(const fs::path& study_folder, const std::string& participant, std::int64_t time) {
    const fs::path own = study_folder / participants_folder_name / participant;
    std::error_code ignored;
    if (participant_number(participant) == 0 || !fs::exists(own, ignored))
        return fail(
            participant_error(own, "there is no such participant", "a folder in participants/, such as P03"));
    if (fs::exists(own / withdrawn_file_name, ignored) && !has_leftovers(own))
        return fail(
            participant_error(own, "this participant has withdrawn the consent", "another participant"));
    BOLT_TRY_ASSIGN(const auto lock,
                    session::FileLock::acquire(own / journal_file_name, (own / journal_file_name).string()));
    return delete_participant(own, time);
}

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
