// Several sessions side by side: did the trainee get better?
#pragma once

#include <span>
#include <string>
#include <vector>

#include "game/report/session_data.hpp"

namespace bolt::report {

// What the overview keeps of a session, so that the rest can be let go.
struct Attempt {
    std::string title, operator_name, law, mode, variant;
    std::uint64_t seed = 0;
    bool complete = true;
    double score = 0.0;
    double duration = 0.0;  // s
    Summary summary;
};
Attempt attempt_of(const SessionData& session);

// The table and the learning curves, as HTML.
std::string attempts_section(std::span<const Attempt> attempts);

}  // namespace bolt::report
