// Result<T>: a value or the Error that explains why there is none. Every boundary returns one.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "engine/base/error.hpp"

namespace bolt {

template <class T>
using Result = tl::expected<T, Error>;

using Status = Result<void>;

inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string expected = {}) {
    Error error;
    error.code = code;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

}  // namespace bolt

// BOLT_TRY(expression) returns the error of a Result or Status from the enclosing function; on success it
// discards the value. BOLT_TRY_ASSIGN(const auto name, expression) does the same and defines `name` as the
// value. The enclosing function has to return a Result or a Status; each stands in a block of its own or
// directly in a function, never as the body of a bare `if`.
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
