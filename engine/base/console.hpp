// What programs say when something is wrong: errors to stderr, and the exit code that goes with them.
#pragma once

#include <span>

#include "engine/base/error.hpp"

namespace bolt {

// Prints "program: message" and returns the exit code.
int complain(const Error& error);

// All of them, a line each, and the most telling exit code (the first one's); 0 when there are none.
int complain(std::span<const Error> errors);

}  // namespace bolt
