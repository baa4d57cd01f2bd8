// An SQLite database and its statements as move-only handles, and the lock of a file that is being recorded.
// Every error names the file.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace bolt::session {

// An error about `file`.
tl::unexpected<Error> file_error(const std::string& file, std::string what, std::string expected = {});

class Statement {
  public:
    // Indices count from 1, as in SQL. Text and bytes are not copied; they must live until the statement has
    // run.
    Statement& bind(int index, std::int64_t value);
    Statement& bind(int index, std::integral auto value) {
        return bind(index, static_cast<std::int64_t>(value));
    }
    Statement& bind(int index, double value);
    Statement& bind(int index, std::string_view value);
    Statement& bind(int index, std::span<const std::byte> value);

    // True: there is a row. False: there are no more rows, and the statement can be run again.
    Result<bool> step();
    Status run();  // for statements without rows

    // Runs the statement with a value for each parameter.
    template <class... Values>
    Status run_with(const Values&... values) {
        int index = 0;
        (bind(++index, values), ...);
        return run();
    }

    // Columns of the row count from 0. Text and bytes live until the next step.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;  // NaN for SQL's NULL, because SQLite stores NaN as NULL
    [[nodiscard]] std::string_view text(int column) const;
    [[nodiscard]] std::span<const std::byte> bytes(int column) const;

  private:
    friend class Database;
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const;
    };
    Statement(sqlite3_stmt* statement, std::string name);

    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    std::string name_;
    int bind_error_ = 0;
};

class Database {
  public:
    // `name` is the file's name in errors. create() fails if the file exists; open() opens it for writing.
    static Result<Database> create(const std::filesystem::path& path, std::string name);
    static Result<Database> open(const std::filesystem::path& path, std::string name);
    // Never changes the file. Reads also the -wal file that a killed writer left beside it, even in a
    // read-only folder.
    static Result<Database> open_read_only(const std::filesystem::path& path, std::string name);

    Status execute(const char* sql);
    Result<Statement> prepare(std::string_view sql);
    [[nodiscard]] bool was_busy() const;  // the last call failed because of another connection

  private:
    struct CloseDatabase {
        void operator()(sqlite3* database) const;
    };
    static Result<Database> open_with(const std::string& file, std::string name, int flags, const char* vfs);
    Database(sqlite3* database, std::string name);

    std::unique_ptr<sqlite3, CloseDatabase> database_;
    std::string name_;
};

// The text of FileLock::acquire()'s error if another program has the lock.
inline constexpr const char* lock_is_taken = "another program is recording into this file";

// Lets one program of this machine at a time record into a file. The lock is held from acquire() until
// destruction or the end of the process. It locks an empty file beside `path`, named with an additional
// ".lock". That file is removed with the lock; one that a killed process leaves is harmless.
class FileLock {
  public:
    // Does not wait. `file` names the file in errors, which give the system's reason.
    static Result<FileLock> acquire(const std::filesystem::path& path, const std::string& file);
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;
    ~FileLock();

  private:
    explicit FileLock(int handle) : handle_(handle) {}

    int handle_;
    std::filesystem::path held_;  // empty: open, but not locked
};

}  // namespace bolt::session
