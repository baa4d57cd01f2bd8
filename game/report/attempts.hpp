// Several sessions side by side: did the trainee get better?
#pragma once

#include <span>
#include <string>
#include <vector>

#include "game/report/session_data.hpp"

namespace bolt::report {

// What the overview keeps of a session, so that the rest can be let go.
struct Attempt {
    std::string assembly, title, operator_name, task, variant, law, mode;
    std::uint64_t seed = 0;
    bool complete = true;
    double score = 0.0;
    double duration = 0.0;  // s
    Summary summary;
};
Attempt attempt_of(const SessionData& session);

// Attempts at the same thing: assembly, task, variant and law. Indices, rising, in the order of the first of
// each.
std::vector<std::vector<std::size_t>> attempt_groups(std::span<const Attempt> attempts);

// The table, and the learning curves of every group of at least two attempts, as HTML.
std::string attempts_section(std::span<const Attempt> attempts);

}  // namespace bolt::report
