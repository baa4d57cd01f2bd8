// What programs say when something is wrong: errors to stderr, and the exit code that goes with them.
#pragma once

#include <span>
#include <string_view>

#include "engine/base/error.hpp"
#include "engine/base/result.hpp"

namespace bolt {

// Prints "program: message" and returns the exit code.
int complain(const Error& error);

// All of them, a line each, and the most telling exit code (the first one's); 0 when there are none.
int complain(std::span<const Error> errors);

// Writes to the standard output and makes sure that it got there: a full disk or a closed pipe is an error.
Status say(std::string_view text);

}  // namespace bolt
