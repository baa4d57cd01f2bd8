// The life of a lesson: a random trainee damages it, then a competent one must be able to finish it.
#pragma once

#include "tests/dead_ends/invariant_checker.hpp"

namespace dead_ends {

struct LifePlan {
    std::uint64_t seed = 0;
    std::string assembly = "cover-m8";
    std::string variant;
    session::LessonOptions options;
    std::string tool;               // empty: the default
    double set_torque_scale = 1.0;  // set torque of a torque wrench, relative to the correct one
    bool at_mouse = true;           // false: at a device, with poses and grips
    double span = 10.0;             // s of random actions
    bool rough = false;             // pulls long and hard at one nut
    bool overtightens = false;      // uses the tools correctly, but tightens too far
};

// A random plan; the same seed gives the same plan.
LifePlan make_life_plan(std::uint64_t seed);
std::string describe(const LifePlan& plan);

struct Life {
    std::vector<std::string> problems;  // empty if the lesson was finished
    double random_time = 0.0, rescue_time = 0.0;
    int restarts = 0;  // of steps, while finishing
    bool done_by_random = false;
};

Life run_life(const LifePlan& plan, const content::Assembly& assembly, Coverage& coverage);

// The assembly of a plan; its lesson is reduced to a few joints.
content::Assembly assembly_of(const LifePlan& plan);

}  // namespace dead_ends
