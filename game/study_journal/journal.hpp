// The record of one participant of a study: an SQLite file to which every answer and every completed step is
// added at once, each synchronised to the disk, so that a killed program, a full disk or a power failure
// loses nothing that was answered.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/session/database.hpp"

namespace bolt::study {

// Behind each kind: the members of JournalEntry that it uses besides `kind` and `time`.
enum class JournalKind : std::uint8_t {
    enrolled,  // text: code of the person; value: place in the balanced order; item: checksum of the plan
    assigned,  // step: "part-1"; item: id of the condition
    language,  // text: ISO 639 code

    answered,   // step, item; value: none if the participant does not want to answer
    agreed,     // step, item: number of the statement of the consent; value: 0 takes the agreement back
    commented,  // step, text
    // step; text: folder of the session, relative to the participant's; item: why an interrupted lesson could
    // not be continued, if this one begins it again
    lesson_begun,
    lesson_continued,  // step; text: folder of the session that has the interrupted lesson and the rest of it
    measured,          // step; item: name of the measure; value: none if the lesson does not have it
    step_done,         // step
    plan_changed,      // item: checksum of the changed plan, with which the participant continues
    clock_set_back,    // value: s by which this entry is earlier than the one before
};
inline constexpr std::size_t journal_kinds = static_cast<std::size_t>(JournalKind::clock_set_back) + 1;

std::string_view name(JournalKind kind);  // as in the file

struct JournalEntry {
    JournalKind kind = JournalKind::enrolled;
    std::int64_t time = 0;  // s since 1970-01-01 UTC
    std::string step, item, text;
    std::optional<double> value;
    bool operator==(const JournalEntry&) const = default;
};

// A clock may be that much behind the last entry, s: clocks are corrected by seconds or minutes.
inline constexpr double tolerated_set_back = 3600.0;

// Seconds since 1970-01-01 UTC as "2026-11-28T15:04:05Z".
std::string time_text(std::int64_t time);
// The date in local time: "2026-11-28".
std::string local_date(std::int64_t time);

// A journal that is open for writing. Only one program at a time can have it.
class Journal {
  public:
    // Creates a journal with its first entries; a program that is killed meanwhile leaves no journal. Fails
    // if the file exists. `simulated`: the answers are not a person's.
    static Result<Journal> create(const std::filesystem::path& file, bool simulated,
                                  std::span<const JournalEntry> first);
    // Fails if another program has it open, or if it is no journal.
    static Result<Journal> open(const std::filesystem::path& file);

    // Adds the entries, all or none, and waits until they are on the disk. Adds a clock_set_back entry
    // before an entry that is earlier than the last one.
    Status append(std::span<const JournalEntry> entries);

    [[nodiscard]] const std::vector<JournalEntry>& entries() const { return entries_; }
    [[nodiscard]] bool simulated() const { return simulated_; }

  private:
    Journal(session::Database database, session::FileLock lock)
        : database_(std::move(database)), lock_(std::move(lock)) {}

    session::Database database_;
    session::FileLock lock_;
    std::vector<JournalEntry> entries_;
    bool simulated_ = false;
};

struct ReadJournal {
    std::vector<JournalEntry> entries;
    bool simulated = false;
};
// Reads a journal that may be open in another program. Repairs one that a killed program left with an
// unfinished entry.
Result<ReadJournal> read_journal(const std::filesystem::path& file);

// The code of the person whose journal it is; empty if the participant is simulated.
std::string person_of(const ReadJournal& journal);

inline constexpr const char* journal_file_name = "journal.db";

// Marks the folder of a participant who withdrew. Any other file in the folder is a leftover to delete.
inline constexpr const char* withdrawn_file_name = "withdrawn.txt";
Status mark_withdrawn(const std::filesystem::path& participant_folder, std::int64_t time);

// Pages and tables with the values of all participants. They are made again on demand, and deleted when a
// participant withdraws.
inline constexpr const char* derived_file_names[] = {"results.html", "results.csv", "results.json",
                                                     "answers.csv", "progress.html"};
// Deletes them in the study of a participant's folder. Returns those that could not be deleted.
std::vector<std::filesystem::path> delete_derived_files(const std::filesystem::path& participant_folder);
}  // namespace bolt::study
