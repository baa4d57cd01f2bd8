#include "game/session/database.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>
#include <utility>

namespace bolt::session {

namespace {

// Far above any text or chunk; limits the allocation for a damaged file.
constexpr int max_value_bytes = 64 << 20;
constexpr int busy_timeout_ms = 2000;

tl::unexpected<Error> database_error(sqlite3* database, const std::string& name) {
    std::string what = database != nullptr ? sqlite3_errmsg(database) : "out of memory";
    const int code = database != nullptr ? sqlite3_errcode(database) : SQLITE_NOMEM;
    const int reason = database != nullptr ? sqlite3_system_errno(database) : 0;
    if ((code == SQLITE_IOERR || code == SQLITE_CANTOPEN) && reason != 0)
        what += fmt::format(" ({})", std::strerror(reason));
    return file_error(name, std::move(what));
}

// A "file:" URI. Escapes characters with a meaning in URIs, since names may contain '?', '#' or '%'.
std::string uri(const std::filesystem::path& path, std::string_view query) {
    std::string text = "file:";
    for (const char c : path.string()) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           c == '/' || c == '.' || c == '-' || c == '_';
        if (plain)
            text += c;
        else
            text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return text.append("?").append(query);
}

bool has_content(const std::filesystem::path& path, const char* suffix) {
    std::error_code missing;
    const auto size = std::filesystem::file_size(path.string() + suffix, missing);
    return !missing && size > 0;
}

}  // namespace

tl::unexpected<Error> file_error(const std::string& file, std::string what, std::string expected) {
    Error error;
    error.file = file;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

Statement::Statement(sqlite3_stmt* statement, std::string name)
    : statement_(statement), name_(std::move(name)) {}

Statement& Statement::bind(int index, std::int64_t value) {
    bind_error_ |= sqlite3_bind_int64(statement_.get(), index, value);
    return *this;
}

Statement& Statement::bind(int index, double value) {
    bind_error_ |= sqlite3_bind_double(statement_.get(), index, value);
    return *this;
}

Statement& Statement::bind(int index, std::string_view value) {
    // A null pointer would be bound as SQL's null, which is not the empty text.
    bind_error_ |= sqlite3_bind_text64(statement_.get(), index, value.empty() ? "" : value.data(),
                                       value.size(), SQLITE_STATIC, SQLITE_UTF8);
    return *this;
}

Statement& Statement::bind(int index, std::span<const std::byte> value) {
    const void* const data = value.empty() ? static_cast<const void*>("") : value.data();  // as above
    bind_error_ |= sqlite3_bind_blob64(statement_.get(), index, data, value.size(), SQLITE_STATIC);
    return *this;
}

Result<bool> Statement::step() {
    sqlite3* const database = sqlite3_db_handle(statement_.get());
    if (bind_error_ != 0) return database_error(database, name_);
    const int code = sqlite3_step(statement_.get());
    if (code == SQLITE_ROW) return true;
    if (code != SQLITE_DONE) {
        auto error = database_error(database, name_);
        sqlite3_reset(statement_.get());
        return error;
    }
    sqlite3_reset(statement_.get());
    return false;
}

Status Statement::run() {
    for (;;) {
        BOLT_TRY_ASSIGN(const auto row, step());
        if (!row) return {};
    }
}

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }

double Statement::real(int column) const {
    if (sqlite3_column_type(statement_.get(), column) == SQLITE_NULL)
        return std::numeric_limits<double>::quiet_NaN();
    return sqlite3_column_double(statement_.get(), column);
}

std::string_view Statement::text(int column) const {
    const std::span<const std::byte> value = bytes(column);
    return {reinterpret_cast<const char*>(value.data()), value.size()};
}

std::span<const std::byte> Statement::bytes(int column) const {
    const auto* data = static_cast<const std::byte*>(sqlite3_column_blob(statement_.get(), column));
    if (data == nullptr) return {};
    return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

void Database::CloseDatabase::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Database::Database(sqlite3* database, std::string name) : database_(database), name_(std::move(name)) {}

Result<Database> Database::open_with(const std::string& file, std::string name, int flags, const char* vfs) {
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(file.c_str(), &handle, flags, vfs);
    Database database(handle, std::move(name));
    if (code != SQLITE_OK) return database_error(handle, database.name_);
    sqlite3_busy_timeout(handle, busy_timeout_ms);
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, max_value_bytes);
    // A file may come from anywhere: its schema must not call functions, and b-tree cells are checked before
    // use.
    sqlite3_db_config(handle, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    BOLT_TRY(database.execute("PRAGMA cell_size_check = ON"));
    return database;
}

Result<Database> Database::create(const std::filesystem::path& path, std::string name) {
    // SQLite would retry to read a file that it cannot create, and then report that the file is missing.
    const int made = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (made < 0)
        return file_error(name, "cannot be created: " + std::generic_category().message(errno),
                          "a folder with write permission");
    (void)::close(made);
    return open(path, std::move(name));
}

Result<Database> Database::open(const std::filesystem::path& path, std::string name) {
    return open_with(path.string(), std::move(name), SQLITE_OPEN_READWRITE, nullptr);
}

Result<Database> Database::open_read_only(const std::filesystem::path& path, std::string name) {
    constexpr const char* probe = "SELECT count(*) FROM sqlite_schema";
    if (!has_content(path, "-wal") && !has_content(path, "-journal")) {
        // There is no writer and nothing to recover, so no locks and no -wal and -shm files are needed.
        BOLT_TRY_ASSIGN(auto database, open_with(uri(path, "immutable=1"), std::move(name),
                                                 SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr));
        BOLT_TRY(database.execute(probe));
        return database;
    }
    BOLT_TRY_ASSIGN(auto shared, open_with(path.string(), name, SQLITE_OPEN_READONLY, nullptr));
    const Status read = shared.execute(probe);
    if (read) return shared;
    const int code = sqlite3_errcode(shared.database_.get());
    if (code != SQLITE_CANTOPEN && code != SQLITE_READONLY) return fail(read.error());
    // The shared index of the -wal file cannot be created in a read-only folder. Keep it in memory, without
    // locks; there can be no writer in such a folder.
    BOLT_TRY_ASSIGN(auto alone, open_with(path.string(), std::move(name), SQLITE_OPEN_READONLY, "unix-none"));
    sqlite3_db_config(alone.database_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    BOLT_TRY(alone.execute("PRAGMA locking_mode = EXCLUSIVE"));
    BOLT_TRY(alone.execute(probe));
    return alone;
}

Status Database::execute(const char* sql) {
    if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK)
        return database_error(database_.get(), name_);
    return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v3(database_.get(), sql.data(), static_cast<int>(sql.size()),
                           SQLITE_PREPARE_PERSISTENT, &statement, nullptr) != SQLITE_OK)
        return database_error(database_.get(), name_);
    return Statement(statement, name_);
}

bool Database::was_busy() const { return sqlite3_errcode(database_.get()) == SQLITE_BUSY; }

namespace {

constexpr int max_attempts = 100;

std::string reason_of(int number) { return std::generic_category().message(number); }

// True if `path` names the open file.
bool is_at(int handle, const std::filesystem::path& path) {
    struct stat open {};
    struct stat named {};
    return ::fstat(handle, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

// A file with content is not a lock, so it is never removed.
bool is_empty_file(int handle) {
    struct stat open {};
    return ::fstat(handle, &open) == 0 && S_ISREG(open.st_mode) && open.st_size == 0;
}

}  // namespace

Result<FileLock> FileLock::acquire(const std::filesystem::path& path, const std::string& file) {
    const std::filesystem::path place = path.string() + ".lock";
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        FileLock lock(::open(place.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
        if (lock.handle_ < 0) {
            const int reason = errno;
            struct stat there {};
            if (::lstat(place.c_str(), &there) == 0)
                return file_error(
                    file, fmt::format("its lock {} cannot be opened: {}", place.string(), reason_of(reason)));
            return file_error(file, "its folder is not writable: " + reason_of(reason),
                              "a folder with write permission");
        }
        if (::flock(lock.handle_, LOCK_EX | LOCK_NB) != 0) {
            if (errno == EWOULDBLOCK)
                return file_error(file, lock_is_taken, "another file, or the end of that recording");
            if (errno == EINTR) continue;
            return file_error(file, "cannot be locked: " + reason_of(errno), "a file system with locks");
        }
        // The previous holder may have removed the file since it was opened; a removed file locks nothing.
        if (!is_at(lock.handle_, place)) continue;
        if (!is_empty_file(lock.handle_))
            return file_error(file, fmt::format("{} is not a lock file", place.string()),
                              "an empty file or none");
        lock.held_ = place;
        return lock;
    }
    return file_error(file, lock_is_taken, "another file, or the end of that recording");
}

FileLock::FileLock(FileLock&& other) noexcept
    : handle_(std::exchange(other.handle_, -1)), held_(std::move(other.held_)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(held_, other.held_);
    return *this;
}

FileLock::~FileLock() {
    if (handle_ < 0) return;
    // Remove the name before the lock is released, so that no other program can have acquired it.
    if (!held_.empty() && is_at(handle_, held_)) (void)::unlink(held_.c_str());
    (void)::close(handle_);
}

}  // namespace bolt::session
