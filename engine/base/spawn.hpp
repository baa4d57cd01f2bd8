// Starts another program: what run_program and Feed stand on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

// A file of ours that the program gets as one of its standard streams.
struct Redirect {
    int ours = -1, as = -1;
};

// The program is looked for on the path; its process id. An error: it cannot be started.
Result<int> spawn(const std::vector<std::string>& command, std::span<const Redirect> redirects);

// Waits for its end; the exit code, −1: a signal ended it.
int wait_for(int child);

}  // namespace bolt
