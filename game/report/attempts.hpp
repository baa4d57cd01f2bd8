// The overview of several sessions: a table of attempts, studies of the guiding force and the view help, and
// learning curves.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "content/trainee/people.hpp"
#include "game/analysis/session_data.hpp"

namespace bolt::report {

// The people that a page may name.
struct TraineeNames {
    // The people in names.json. A session with a typed name in place of a code belongs to the person of that
    // name.
    std::vector<content::Person> people;
    bool show = false;  // false: the page has codes only, so that it can be passed on
};

// The values of a session that the overview needs, so that the session itself can be released.
struct Attempt {
    std::string assembly, title, task, variant, law, mode;
    std::string trainee;  // result of trainee_text; identifies the trainee together with trainee_kind
    session::TraineeKind trainee_kind = session::TraineeKind::unrecorded;
    std::string person;  // code, or the typed name of an older program; empty: no person, or unknown
    std::uint64_t seed = 0;
    bool complete = true, finished = false;
    double score = 0.0;
    double duration = 0.0;  // s
    analysis::Summary summary;

    // Haptic metrics; NaN: unknown.
    bool guided = false, view_help = false, obstacles = false;
    double time_to_nut = 0.0, time_near_nut = 0.0;  // s, medians over the steps with the wrench
    double visible_share = 0.0;  // 0…1, share of all time near the nuts in which they were visible
    double obstacle_contacts = 0.0, contact_time = 0.0;  // count, s
    // Change of the force in a millisecond, as shares of the device's maximum: the largest and the 99th
    // percentile.
    double greatest_change = 0.0, p99_change = 0.0;
};

// "T-7K3M9Q", "novice (simulated)", "Ada (simulated novice)" or "person without a name"; with names "Ada
// (T-7K3M9Q)". A typed name of an older program stands for its code, if that is known. For a session that
// does not record who held the tool: "novice (person or simulated: not recorded)".
std::string trainee_text(const session::Header& header, const TraineeNames& names = {});

Attempt attempt_of(const analysis::SessionData& session, const TraineeNames& names = {});

// Groups attempts with the same assembly, title, task, variant and law. The indices of a group are ascending;
// the groups are in the order of their first attempts.
std::vector<std::vector<std::size_t>> attempt_groups(std::span<const Attempt> attempts);

// HTML: the table, the studies, and the learning curves of every group in which a trainee has at least two
// attempts. `overview_only`: the page has no sections of single sessions. Then the table has no links, and
// where there are studies there are no learning curves.
std::string attempts_section(std::span<const Attempt> attempts, bool overview_only = false);

// HTML: compares attempts with and without the guiding force that otherwise differ at most in the seed. One
// part for each set of such attempts, in the order of their first attempts. Empty if no set has both kinds.
std::string guiding_study(std::span<const Attempt> attempts);

// HTML: the same comparison for the view help.
std::string view_study(std::span<const Attempt> attempts);

// Splits `group` by trainee, in the order of each trainee's first attempt. Indices into `attempts`.
std::vector<std::vector<std::size_t>> split_by_trainee(std::span<const Attempt> attempts,
                                                       std::span<const std::size_t> group);

// HTML: the learning curves of one group (attempt_groups), with a set of plots for each trainee that has at
// least two attempts. All sets have the same axes. Several trainees are summarised in a table before the
// plots. Empty if no trainee has two attempts. `linked`: the page has a section for each attempt.
std::string learning_curves_section(std::span<const Attempt> attempts, std::span<const std::size_t> group,
                                    bool linked);

}  // namespace bolt::report
