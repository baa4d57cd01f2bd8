// Console output of programs: errors to stderr with their exit code, results to stdout.
#pragma once

#include <span>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/base/result.hpp"

namespace bolt {

// Prints the message to stderr and returns the exit code.
int print_error(const Error& error);

// Prints each message on its own line and returns the exit code of the first error; 0 if there are none.
int print_error(std::span<const Error> errors);

// Writes to the standard output and flushes it. Fails if the output is a full disk or a closed pipe.
Status print(std::string_view text);

}  // namespace bolt
