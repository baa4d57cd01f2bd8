// An error as a value: what is wrong, where, and what was expected instead.
#pragma once

#include <string>

namespace bolt {

// The exit codes of every program, in the order of severity that a caller may act on.
enum class ErrorCode {
    failed = 1,       // the work itself failed: a full disk, a broken session file
    usage = 2,        // the command line is wrong
    bad_content = 3,  // a content file is wrong
    no_device = 4,    // a requested device or GPU is missing
};

struct Error {
    ErrorCode code = ErrorCode::failed;
    std::string what;      // one clause that states what is wrong: "is an object"
    std::string expected;  // "an array", or a question "did you mean \"size\"?"; may be empty
    std::string file;      // empty if no file is involved
    int line = 0;          // 1-based; 0: unknown
    int column = 0;        // 1-based, in characters (Unicode code points); 0: unknown
    std::string pointer;   // JSON pointer (RFC 6901) of the value; may be empty
    bool lost = false;     // the device worked and has disappeared: opening it again may help

    // "file:line:column: pointer: what; expected expected" without the unknown parts. The word "expected" is
    // inserted unless the text already begins with "expected" or "did you mean".
    [[nodiscard]] std::string message() const;
};

}  // namespace bolt
