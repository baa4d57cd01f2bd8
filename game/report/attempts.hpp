// Several sessions side by side: did the trainee get better?
#pragma once

#include <span>
#include <string>
#include <vector>

#include "game/analysis/session_data.hpp"

namespace bolt::report {

// What the overview keeps of a session, so that the rest can be let go.
struct Attempt {
    std::string assembly, title, task, variant, law, mode;
    std::string trainee;  // as trainee_text says it; with the kind it tells trainees apart
    session::OperatorKind operator_kind = session::OperatorKind::unrecorded;
    std::uint64_t seed = 0;
    bool complete = true, finished = false;
    double score = 0.0;
    double duration = 0.0;  // s
    analysis::Summary summary;

    // Of what was felt; NaN where it is not known.
    bool guided = false, view_help = false, obstacles = false;
    double to_nut = 0.0, near_nut = 0.0;  // s with the wrench, medians over the steps
    double seen = 0.0;                    // 0…1 of the time near the nuts with them in sight
    double bumps = 0.0, bump_time = 0.0;  // count, s
    // Of the force in a millisecond, as shares of the device's greatest; the latter the 99th percentile.
    double greatest_change = 0.0, usual_change = 0.0;
};

// "Ada", "novice (simulated)", "Ada (simulated novice)", "person without a name"; for a session that does not
// record who held the tool "novice (person or simulated: not recorded)".
std::string trainee_text(const session::Header& header);

Attempt attempt_of(const analysis::SessionData& session);

// Attempts at the same thing: assembly, task, variant and law. Indices, rising, in the order of the first of
// each.
std::vector<std::vector<std::size_t>> attempt_groups(std::span<const Attempt> attempts);

// As HTML: the table, what guiding did (guiding_study.hpp), and the learning curves of every group of at
// least two attempts. Alone on its page it names no sections to go to, and a study has no learning curves.
std::string attempts_section(std::span<const Attempt> attempts, bool alone = false);

// What a help does: lessons with it beside the same lessons without it.

// A part for each set of attempts that differ in nothing but the guiding and the seed, in the order of the
// first of each; nothing if there is no such set with both.
std::string guiding_study(std::span<const Attempt> attempts);

// The same of the help with the view, by simulated trainees.
std::string view_study(std::span<const Attempt> attempts);

}  // namespace bolt::report
