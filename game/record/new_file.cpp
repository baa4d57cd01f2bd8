#include "game/record/new_file.hpp"

#include <fmt/format.h>

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

bool is_in_use(const std::filesystem::path& path, const std::string& file) {
    auto database = Database::open(path, file);
    if (!database) return false;
    return !database->execute("PRAGMA busy_timeout = 0; PRAGMA locking_mode = EXCLUSIVE; BEGIN EXCLUSIVE") &&
           database->was_busy();
}

// Errors are left alone: what is not there needs no removing, and what cannot be removed cannot be replaced
// either.
void remove_logs(const std::filesystem::path& path) {
    std::error_code ignored;
    for (const char* suffix : {"-wal", "-shm", "-journal"})
        std::filesystem::remove(path.string() + suffix, ignored);
}

void remove_with_logs(const std::filesystem::path& path) {
    std::error_code ignored;
    remove_logs(path);
    std::filesystem::remove(path, ignored);
}

}  // namespace

Status make_new_file(const std::filesystem::path& path, const std::string& file, const Header& header,
                     Seals& seals) {
    std::error_code status;
    std::filesystem::create_directories(path.parent_path(), status);
    if (status) return file_error(file, "its folder cannot be made: " + status.message());
    const auto there = std::filesystem::status(path, status);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
        return file_error(file, "there is something that is not a file");
    if (std::filesystem::exists(there) && is_in_use(path, file))
        return file_error(file, "cannot be replaced while it is open elsewhere");

    const std::filesystem::path part = path.string() + ".part";
    remove_with_logs(part);
    if (auto made = make_empty(part, file, header, seals); !made) {
        remove_with_logs(part);
        return made;
    }
    // The old log goes before the old file: SQLite would take it for the new file's.
    remove_logs(path);
    std::filesystem::rename(part, path, status);
    if (!status) return {};
    remove_with_logs(part);
    return file_error(file, "cannot be replaced: " + status.message());
}

}  // namespace bolt::record
