// Reproduces a problem that the 2018 paper reports, with and without the guiding force: a hand that does not
// see the nut reaches for it with the wrench, hits the casing on its way, and feels a jerk.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tools/verify/arms/arm_rig.hpp"

namespace bolt::arm_validation {

struct Approach {
    bool reached = false;        // the jaw reached the nut
    double way = 0.0;            // m, path of the jaw until it reached the nut, or in all attempts
    double straight = 0.0;       // m from the start to the nut
    double time = 0.0;           // s until the jaw reached the nut, or of all attempts
    int bumps = 0;               // contacts with anything but the nut
    double contact_force = 0.0;  // N, the largest force of contact on the hand
    double force = 0.0;          // N, the largest force on the hand, guiding included
    double step = 0.0;           // N, the largest change of the force in a millisecond
};

// Runs one reach from a random place near a random nut: straight, with minimum jerk, at the speed of a
// person, and with an error of aim. If the jaw does not reach the nut, the hand tries again from where it is.
Approach run_approach(TightenedAssembly& tightened, const ArmFacts& arm, std::uint64_t seed, bool guided);

struct ApproachSummary {
    std::size_t count = 0, missed = 0;
    double way_ratio = 0.0, time = 0.0;  // medians of those that reached the nut: way / straight, s
    double bumps = 0.0;                  // mean
    double force_median = 0.0, force_p95 = 0.0, force_max = 0.0;  // N, of contact
    double step_p95 = 0.0, step_max = 0.0;                        // N in a millisecond
};
ApproachSummary summarize(std::span<const Approach> approaches);

}  // namespace bolt::arm_validation
