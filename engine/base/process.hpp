// Another program run to its end.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

struct Finished {
    int exit_code = 0;  // −1: a signal ended it
    std::string said;
};

enum class Hear : std::uint8_t { output, output_and_errors };

// The program is looked for on the path; its input is ours. An error: it cannot be started.
Result<Finished> run_program(const std::vector<std::string>& command, Hear hear);

}  // namespace bolt
