// An SQLite database and its statements as move-only handles. Every failure is an Error that names the file.
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

// `what` is wrong with `file`.
tl::unexpected<Error> file_error(const std::string& file, std::string what);

class Statement {
  public:
    // Indices count from 1, as in SQL. Text and bytes are not copied: they have to live until the statement
    // has run.
    Statement& bind(int index, std::int64_t value);
    Statement& bind(int index, std::integral auto value) {
        return bind(index, static_cast<std::int64_t>(value));
    }
    Statement& bind(int index, double value);
    Statement& bind(int index, std::string_view value);
    Statement& bind(int index, std::span<const std::byte> value);

    Result<bool>
    step();        // true: there is a row; false: there are no more, and the statement can be run again
    Status run();  // for statements that give no rows

    // Runs it with a value for each parameter.
    template <class... Values>
    Status run_with(const Values&... values) {
        int index = 0;
        (bind(++index, values), ...);
        return run();
    }

    // Columns of the row count from 0. Text and bytes live until the next step.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;  // NaN where SQL has null: SQLite keeps no NaN
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
    // `name` is what errors call the file.
    static Result<Database> create(const std::filesystem::path& path,
                                   std::string name);  // makes it; an error if it is there
    static Result<Database> open(const std::filesystem::path& path, std::string name);  // to write on
    // Never changes the file. What a killed writer left in the -wal file beside it is seen, in a folder where
    // nothing can be written too.
    static Result<Database> open_to_read(const std::filesystem::path& path, std::string name);

    Status execute(const char* sql);
    Result<Statement> prepare(std::string_view sql);
    [[nodiscard]] bool was_busy() const;  // the last call failed because another connection is in the way

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    static Result<Database> open_with(const std::string& file, std::string name, int flags, const char* vfs);
    Database(sqlite3* database, std::string name);

    std::unique_ptr<sqlite3, Close> database_;
    std::string name_;
};

// Lets one program of this machine at a time record into a file.

// Held from take() until destruction or the end of the process. It locks an empty file beside `path`, named
// with an additional ".lock". That file is removed with the lock; one that a killed process leaves does no
// harm.
class FileLock {
  public:
    // Does not wait. `file` names the file in errors, which give the system's reason.
    static Result<FileLock> take(const std::filesystem::path& path, const std::string& file);
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;
    ~FileLock();

  private:
    explicit FileLock(int handle) : handle_(handle) {}

    int handle_;
    std::filesystem::path held_;  // empty: open, but not locked
};

}  // namespace bolt::session
