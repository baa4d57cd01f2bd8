#include "game/record/new_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "game/record/database.hpp"
#include "game/record/format.hpp"

namespace bolt::record {

namespace {

Status make_empty(const std::filesystem::path& path, const std::string& file, const Header& header,
                  Seals& seals) {
    auto database = Database::create(path, file);
    if (!database) return fail(database.error());
    const std::string setup =
        fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id, format_version);
    if (auto done = database->execute(setup.c_str()); !done) return done;
    auto filled = transaction(*database, [&]() -> Status {
        if (auto made = database->execute(schema); !made) return made;
        if (auto put = put_header(*database, header, seals); !put) return put;
        return put_seals(*database, seals);
    });
    if (!filled) return filled;
    return database->execute("PRAGMA journal_mode = WAL");
}

// Brings the old session out of its log into its file, so that one rename moves all of it; what cannot be
// brought stays in the log. False: it is open elsewhere.
bool gather(const std::filesystem::path& path, const std::string& file) {
    auto database = Database::open(path, file);
    if (!database) return true;
    if (!database->execute("PRAGMA busy_timeout = 0; PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE"))
        return !database->was_busy();
    (void)database->execute("ROLLBACK; PRAGMA journal_mode = MEMORY");
    return true;
}

// Errors are left alone: what is not there needs no removing, and what cannot be removed cannot be replaced
// either.
void remove_logs(const std::filesystem::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"-wal", "-shm", "-journal"})
        std::filesystem::remove(path.string() + suffix, ignored);
}

void remove_with_logs(const std::filesystem::path& path) {
    remove_logs(path);
    (void)::unlink(path.c_str());  // not a folder, which std::filesystem would remove as well
}

std::filesystem::path previous_of(const std::filesystem::path& path) {
    return path.parent_path() / (path.stem().string() + ".previous" + path.extension().string());
}

// Nothing was recorded: keeping it would only push out what was kept before it.
bool holds_nothing(const std::filesystem::path& path) {
    std::error_code unknown;
    if (std::filesystem::file_size(path, unknown) == 0 && !unknown) return true;
    const auto session = Reader::open(path);
    return session && !session->complete() && session->tick_count() == 0;
}

// Gives the old file, and what is left of its logs, the name under which it is kept. Where a file can have
// two names, dying anywhere in here loses nothing: the next one who creates goes on where this one was.
Status keep_old(const std::filesystem::path& path, const std::string& file) {
    const std::filesystem::path kept = previous_of(path);
    const auto claimed = FileLock::take(kept, kept.string());
    if (!claimed) return fail(claimed.error());
    std::error_code status;
    if (!std::filesystem::equivalent(path, kept, status)) {
        remove_with_logs(kept);
        // A second name, so that there is a session under the first one all the time. Not every file system
        // can do that, nor every user to others' files.
        std::filesystem::create_hard_link(path, kept, status);
        if (status) std::filesystem::rename(path, kept, status);
        if (status)
            return file_error(file, fmt::format("cannot be replaced: what is there cannot be kept as {}: {}",
                                                kept.string(), status.message()));
    }
    for (const char* suffix : {"-wal", "-journal"}) {
        const std::filesystem::path log = path.string() + suffix;
        if (std::filesystem::exists(log, status))
            std::filesystem::rename(log, kept.string() + suffix, status);
        if (status)
            return file_error(file, fmt::format("cannot be replaced: {} cannot be moved: {}", log.string(),
                                                status.message()));
    }
    return {};
}

}  // namespace

Result<FileLock> claim_place(const std::filesystem::path& path, const std::string& file) {
    std::error_code status;
    std::filesystem::create_directories(path.parent_path(), status);
    if (status) return file_error(file, "its folder cannot be made: " + status.message());
    const auto there = std::filesystem::status(path, status);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
        return file_error(file, "there is something that is not a file");
    return FileLock::take(path, file);
}

Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     Seals& seals) {
    std::error_code status;
    const bool is_there = std::filesystem::exists(path, status);
    if (status) return file_error(file, "cannot be replaced: " + status.message());
    if (is_there && !gather(path, file))
        return file_error(file, "cannot be replaced while it is open elsewhere");

    const std::filesystem::path part = path.string() + ".part";
    remove_with_logs(part);
    Status made = make_empty(part, file, header, seals);
    if (made && is_there && !holds_nothing(path)) made = keep_old(path, file);
    if (!made) {
        remove_with_logs(part);
        return made;
    }
    // A log that is still here belongs to no session: SQLite would take it for the new file's.
    remove_logs(path);
    std::filesystem::rename(part, path, status);
    if (!status) return {};
    remove_with_logs(part);
    return file_error(file, "cannot be replaced: " + status.message());
}

}  // namespace bolt::record
