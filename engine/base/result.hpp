// Errors as values: Error, Result, and their propagation and output.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace bolt {

// The value is the exit code of the program.
enum class ErrorCode {
    failed = 1,       // the work itself failed: a full disk, a broken session file
    usage = 2,        // the command line is wrong
    bad_content = 3,  // a content file is wrong
    no_device = 4,    // a requested device or GPU is missing
};

// Facts about an error, for the code that handles it. The library that makes the error derives its own type.
struct ErrorDetail {
    ErrorDetail() = default;
    ErrorDetail(const ErrorDetail&) = default;
    ErrorDetail& operator=(const ErrorDetail&) = default;
    virtual ~ErrorDetail() = default;
};

// States what is wrong, where, and what was expected instead.
struct Error {
    ErrorCode code = ErrorCode::failed;
    std::string what;      // one clause that states what is wrong: "is an object"
    std::string expected;  // "an array", or a question "did you mean \"size\"?"; may be empty
    std::string file;      // empty if no file is involved
    int line = 0;          // 1-based; 0: unknown
    int column = 0;        // 1-based, in characters (Unicode code points); 0: unknown
    std::string pointer;   // JSON pointer (RFC 6901) of the value; may be empty
    bool lost = false;     // a device that worked before has disappeared; reopening it may succeed
    std::shared_ptr<const ErrorDetail> detail{};  // null: none

    // Returns "<file>:<line>:<column>: <pointer>: <what>; expected <expected>" without the unknown parts. The
    // word "expected" is left out if the member already begins with "expected" or "did you mean".
    [[nodiscard]] std::string message() const;
};

// A value, or the Error that explains why there is none.
template <class T>
using Result = tl::expected<T, Error>;

using Status = Result<void>;

inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string expected) {
    Error error;
    error.code = code;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

}  // namespace bolt

// BOLT_TRY(expression) returns the error of a Result or Status from the enclosing function; without an error
// it discards the value. BOLT_TRY_ASSIGN(const auto name, expression) does the same and defines `name` as the
// value. The enclosing function must return a Result or a Status. BOLT_TRY_ASSIGN expands to several
// statements: never use it as the body of an `if` without braces.
#define BOLT_TRY(...) BOLT_TRY_AT(__LINE__, __VA_ARGS__)
#define BOLT_TRY_AT(line, ...) BOLT_TRY_IN(line, __VA_ARGS__)
#define BOLT_TRY_IN(line, ...)                                            \
    do {                                                                  \
        if (auto bolt_status_##line = (__VA_ARGS__); !bolt_status_##line) \
            return ::bolt::fail(std::move(bolt_status_##line).error());   \
    } while (false)
#define BOLT_TRY_ASSIGN(definition, ...) BOLT_TRY_ASSIGN_AT(__LINE__, definition, __VA_ARGS__)
#define BOLT_TRY_ASSIGN_AT(line, definition, ...) BOLT_TRY_ASSIGN_TO(line, definition, __VA_ARGS__)
#define BOLT_TRY_ASSIGN_TO(line, definition, ...)                                        \
    auto bolt_result_##line = (__VA_ARGS__);                                             \
    if (!bolt_result_##line) return ::bolt::fail(std::move(bolt_result_##line).error()); \
    definition = *std::move(bolt_result_##line)

namespace bolt {

// Prints the message to stderr and returns the exit code.
int print_error(const Error& error);

// Prints each message on its own line and returns the exit code of the first error; 0 if there are none.
int print_error(std::span<const Error> errors);

// Writes to the standard output and flushes it. Fails if the output is a full disk or a closed pipe.
Status print(std::string_view text);

}  // namespace bolt
