#include "game/study_journal/journal.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>

#include "engine/base/file.hpp"

namespace bolt::study {

namespace {

constexpr std::int64_t application_id = 0x626F6C74;  // "bolt"; the format is that of the table's name
constexpr const char* create_tables =
    "CREATE TABLE study_journal_1 (n INTEGER PRIMARY KEY, kind TEXT NOT NULL, time TEXT NOT NULL, step TEXT "
    "NOT NULL, item TEXT NOT NULL, value REAL, text TEXT NOT NULL); CREATE TABLE study_properties_1 "
    "(simulated INTEGER NOT NULL);";

// In the order of JournalKind.
constexpr std::string_view kind_names[journal_kinds] = {
    "enrolled",     "assigned",         "language", "answered",  "agreed",       "commented",
    "lesson_begun", "lesson_continued", "measured", "step_done", "plan_changed", "clock_set_back"};

// The inverse of time_text(). None if the text has another form.
std::optional<std::int64_t> parse_time(const std::string& text) {
    std::tm parts{};
    char end = 0;
    if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2d%c", &parts.tm_year, &parts.tm_mon, &parts.tm_mday,
                    &parts.tm_hour, &parts.tm_min, &parts.tm_sec, &end) != 7 ||
        end != 'Z')
        return std::nullopt;
    parts.tm_year -= 1900;
    parts.tm_mon -= 1;
    return timegm(&parts);
}

Result<ReadJournal> read_entries(session::Database& database, const std::string& file) {
    auto properties = database.prepare("SELECT simulated FROM study_properties_1");
    if (!properties)
        return session::file_error(file, "is no journal of a study", "journal.db of a participant");
    BOLT_TRY_ASSIGN(const bool has_properties, properties->step());
    ReadJournal read;
    read.simulated = has_properties && properties->integer(0) != 0;
    BOLT_TRY_ASSIGN(
        auto rows,
        database.prepare("SELECT n, kind, time, step, item, value, text FROM study_journal_1 ORDER BY n"));
    for (;;) {
        BOLT_TRY_ASSIGN(const bool row, rows.step());
        if (!row) break;
        JournalEntry entry;
        const auto* const kind = std::find(std::begin(kind_names), std::end(kind_names), rows.text(1));
        const std::optional<std::int64_t> time = parse_time(std::string(rows.text(2)));
        if (kind == std::end(kind_names) || !time)
            return session::file_error(file, fmt::format("entry {} cannot be read", rows.integer(0)),
                                       "a journal of this version of the program");
        entry.kind = static_cast<JournalKind>(kind - kind_names);
        entry.time = *time;
        entry.step = rows.text(3);
        entry.item = rows.text(4);
        if (const double value = rows.real(5); !std::isnan(value)) entry.value = value;
        entry.text = rows.text(6);
        read.entries.push_back(std::move(entry));
    }
    return read;
}

Status insert(session::Database& database, std::size_t number, const JournalEntry& entry) {
    BOLT_TRY_ASSIGN(auto statement,
                    database.prepare("INSERT INTO study_journal_1 VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7)"));
    const std::string time = time_text(entry.time);
    statement.bind(1, number);
    statement.bind(2, kind_names[static_cast<std::size_t>(entry.kind)]);
    statement.bind(3, std::string_view(time));
    statement.bind(4, std::string_view(entry.step));
    statement.bind(5, std::string_view(entry.item));
    if (entry.value) statement.bind(6, *entry.value);
    statement.bind(7, std::string_view(entry.text));
    return statement.run();
}

// EXTRA also synchronises the folder after a commit, so that a power failure cannot bring the old state back.
constexpr const char* durable = "PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA";

}  // namespace

std::string_view name(JournalKind kind) { return kind_names[static_cast<std::size_t>(kind)]; }

std::string time_text(std::int64_t time) {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(time)));
}

std::string local_date(std::int64_t time) {
    return fmt::format("{:%Y-%m-%d}", fmt::localtime(static_cast<std::time_t>(time)));
}

Result<Journal> Journal::create(const std::filesystem::path& file, bool simulated,
                                std::span<const JournalEntry> first) {
    const std::string name = file.string();
    std::error_code problem;
    if (std::filesystem::exists(file, problem))
        return session::file_error(name, "exists already", "a participant without a journal");
    // The file gets its name when it is complete.
    const std::filesystem::path part = name + ".part";
    std::filesystem::remove(part, problem);
    {
        BOLT_TRY_ASSIGN(const auto lock, session::FileLock::acquire(part, name));
        BOLT_TRY_ASSIGN(auto database, session::Database::create(part, name));
        BOLT_TRY(database.execute(durable));
        BOLT_TRY(database.execute(
            fmt::format("BEGIN; PRAGMA application_id = {}; {} INSERT INTO study_properties_1 VALUES ({})",
                        application_id, create_tables, simulated ? 1 : 0)
                .c_str()));
        for (std::size_t i = 0; i < first.size(); ++i) BOLT_TRY(insert(database, i, first[i]));
        BOLT_TRY(database.execute("COMMIT"));
    }
    std::filesystem::rename(part, file, problem);
    if (problem) return session::file_error(name, "cannot be created: " + problem.message());
    return open(file);
}

Result<Journal> Journal::open(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code missing;
    if (!std::filesystem::exists(file, missing))
        return session::file_error(name, "does not exist", "journal.db of a participant");
    BOLT_TRY_ASSIGN(auto lock, session::FileLock::acquire(file, name));
    BOLT_TRY_ASSIGN(auto database, session::Database::open(file, name));
    BOLT_TRY(database.execute(durable));
    BOLT_TRY_ASSIGN(auto read, read_entries(database, name));
    Journal journal(std::move(database), std::move(lock));
    journal.entries_ = std::move(read.entries);
    journal.simulated_ = read.simulated;
    return journal;
}

Status Journal::append(std::span<const JournalEntry> entries) {
    std::vector<JournalEntry> added;
    std::int64_t latest = entries_.empty() ? std::numeric_limits<std::int64_t>::min() : entries_.back().time;
    for (const JournalEntry& entry : entries) {
        if (entry.time < latest && entry.kind != JournalKind::clock_set_back)
            added.push_back({JournalKind::clock_set_back,
                             entry.time,
                             {},
                             {},
                             {},
                             static_cast<double>(latest - entry.time)});
        latest = entry.time;
        added.push_back(entry);
    }
    BOLT_TRY(database_.execute("BEGIN IMMEDIATE"));
    Status written;
    for (std::size_t i = 0; written && i < added.size(); ++i)
        written = insert(database_, entries_.size() + i, added[i]);
    if (written) written = database_.execute("COMMIT");
    if (!written) {
        (void)database_.execute("ROLLBACK");
        return written;
    }
    entries_.insert(entries_.end(), added.begin(), added.end());
    return {};
}

Result<ReadJournal> read_journal(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code unknown;
    if (std::filesystem::exists(name + "-journal", unknown)) {
        // A killed program has left an unfinished entry, which only a writer can remove. While another
        // program is at work, the entry is finished soon.
        if (const auto lock = session::FileLock::acquire(file, name)) {
            BOLT_TRY_ASSIGN(auto database, session::Database::open(file, name));
            return read_entries(database, name);
        }
    }
    BOLT_TRY_ASSIGN(auto database, session::Database::open_read_only(file, name));
    return read_entries(database, name);
}

std::string person_of(const ReadJournal& journal) {
    const bool person = !journal.simulated && !journal.entries.empty() &&
                        journal.entries.front().kind == JournalKind::enrolled;
    return person ? journal.entries.front().text : std::string();
}

Status mark_withdrawn(const std::filesystem::path& participant_folder, std::int64_t time) {
    return write_file(participant_folder / withdrawn_file_name,
                      fmt::format("{} withdrew the consent on {}. Everything else was deleted.\n",
                                  participant_folder.filename().string(), time_text(time).substr(0, 10)));
}

std::vector<std::filesystem::path> delete_derived_files(const std::filesystem::path& participant_folder) {
    const std::filesystem::path study = participant_folder.parent_path().parent_path();
    std::vector<std::filesystem::path> left;
    for (const char* file_name : derived_file_names) {
        std::error_code failed;
        std::filesystem::remove(study / file_name, failed);
        if (failed) left.push_back(study / file_name);
    }
    return left;
}

}  // namespace bolt::study
