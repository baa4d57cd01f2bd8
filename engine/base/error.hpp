// An error is a value: what went wrong, where, and what was expected instead.
#pragma once

#include <string>

namespace bolt {

// The exit codes of every program (also the order of severity a caller may act on).
enum class ErrorCode {
    failed = 1,       // the work itself failed: disk full, broken session file
    usage = 2,        // the command line is wrong
    bad_content = 3,  // a content file is wrong
    no_device = 4,    // a device or GPU that was asked for is not there
};

struct Error {
    ErrorCode code = ErrorCode::failed;
    std::string what;      // one sentence: what is wrong
    std::string expected;  // what was expected, or the nearest valid name; may be empty
    std::string file;      // empty when no file is involved
    int line = 0;          // 1-based; 0 when unknown
    int column = 0;        // 1-based, in characters (Unicode code points); 0 when unknown
    std::string pointer;   // JSON pointer (RFC 6901) of the value, may be empty
    bool lost = false;     // a device was there and is gone: opening it anew may help

    // "file:line:column: what is wrong; what was expected", leaving out what is not known.
    [[nodiscard]] std::string message() const;
};

}  // namespace bolt
