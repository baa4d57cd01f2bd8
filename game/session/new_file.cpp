#include "game/session/new_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "game/session/database.hpp"
#include "game/session/format.hpp"

namespace bolt::session {

namespace {

Status make_empty(const std::filesystem::path& path, const std::string& file, const Header& header,
                  TableChecksums& checksums) {
    BOLT_TRY_ASSIGN(auto database, Database::create(path, file));
    const std::string setup =
        fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}", application_id, format_version);
    BOLT_TRY(database.execute(setup.c_str()));
    BOLT_TRY(transaction(database, [&]() -> Status {
        BOLT_TRY(database.execute(schema));
        BOLT_TRY(put_header(database, header, checksums));
        return put_checksums(database, checksums);
    }));
    return database.execute("PRAGMA journal_mode = WAL");
}

// Merges the write-ahead log of the old session into its file, so that one rename moves all of it. What
// cannot be merged stays in the log. False if the session is open elsewhere.
bool gather(const std::filesystem::path& path, const std::string& file) {
    auto database = Database::open(path, file);
    if (!database) return true;
    if (!database->execute("PRAGMA busy_timeout = 0; PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE"))
        return !database->was_busy();
    (void)database->execute("ROLLBACK; PRAGMA journal_mode = MEMORY");
    return true;
}

// Ignores errors: a missing file needs no removal, and one that cannot be removed makes the replacement fail
// too.
void remove_logs(const std::filesystem::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"-wal", "-shm", "-journal"})
        std::filesystem::remove(path.string() + suffix, ignored);
}

void remove_with_logs(const std::filesystem::path& path) {
    remove_logs(path);
    (void)::unlink(path.c_str());  // never a folder, which std::filesystem::remove would delete
}

std::filesystem::path previous_of(const std::filesystem::path& path) {
    return path.parent_path() / (path.stem().string() + ".previous" + path.extension().string());
}

// True if nothing was recorded; keeping such a file would replace a session that was kept earlier.
bool holds_nothing(const std::filesystem::path& path) {
    std::error_code unknown;
    if (std::filesystem::file_size(path, unknown) == 0 && !unknown) return true;
    const auto session = Reader::open(path);
    return session && !session->complete() && session->tick_count() == 0;
}

// Renames the old file and its remaining logs to the name under which they are kept. On file systems with
// hard links a crash in here loses nothing: the next create() continues.
Status keep_old(const std::filesystem::path& path, const std::string& file) {
    const std::filesystem::path kept = previous_of(path);
    BOLT_TRY(FileLock::take(kept, kept.string()));
    std::error_code status;
    if (!std::filesystem::equivalent(path, kept, status)) {
        remove_with_logs(kept);
        // A hard link, so that `path` names a session all the time. Not all file systems allow it, nor all
        // users for files of others.
        std::filesystem::create_hard_link(path, kept, status);
        if (status) std::filesystem::rename(path, kept, status);
        if (status)
            return file_error(file, fmt::format("cannot be replaced: the old file cannot be kept as {}: {}",
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
    if (status) return file_error(file, "its folder cannot be created: " + status.message());
    const auto there = std::filesystem::status(path, status);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
        return file_error(file, "is not a regular file");
    return FileLock::take(path, file);
}

Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     TableChecksums& checksums) {
    std::error_code status;
    const bool is_there = std::filesystem::exists(path, status);
    if (status) return file_error(file, "cannot be replaced: " + status.message());
    if (is_there && !gather(path, file))
        return file_error(file, "cannot be replaced while it is open elsewhere");

    const std::filesystem::path part = path.string() + ".part";
    remove_with_logs(part);
    Status made = make_empty(part, file, header, checksums);
    if (made && is_there && !holds_nothing(path)) made = keep_old(path, file);
    if (!made) {
        remove_with_logs(part);
        return made;
    }
    // SQLite would apply a log that is still here to the new file.
    remove_logs(path);
    std::filesystem::rename(part, path, status);
    if (!status) return {};
    remove_with_logs(part);
    return file_error(file, "cannot be replaced: " + status.message());
}

}  // namespace bolt::session
