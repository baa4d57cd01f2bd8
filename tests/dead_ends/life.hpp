// The life of a lesson: a random trainee damages it, then a competent one must be able to finish it.
#pragma once

#include "tests/dead_ends/watch.hpp"

namespace dead_ends {

struct Person {
    std::uint64_t seed = 0;
    std::string assembly = "cover-m8";
    std::string variant;
    session::CourseOptions course;
    std::string tool;       // empty: the default
    double sets = 1.0;      // the setting of a torque wrench, as a share of the right one
    bool at_mouse = true;   // else at a device: poses and grips
    double span = 10.0;     // s of random actions
    bool rough = false;     // pulls long and hard at one nut
    bool overdoes = false;  // uses the tools correctly, but tightens too far
};

// A random person; the same seed gives the same person.
Person person(std::uint64_t seed);
std::string describe(const Person& person);

struct Life {
    std::vector<std::string> troubles;  // empty if the lesson was finished
    double random_time = 0.0, rescue_time = 0.0;
    int restarts = 0;  // of steps, while finishing
    bool done_by_random = false;
};

Life live(const Person& person, const content::Assembly& assembly, Met& met);

// The assembly of a person; its lesson is reduced to a few joints.
content::Assembly assembly_of(const Person& person);

}  // namespace dead_ends
