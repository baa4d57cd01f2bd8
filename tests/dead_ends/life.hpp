// Somebody who does anything at all to a lesson, and somebody competent who then takes over and has to be
// able to finish it.
#pragma once

#include "tests/dead_ends/watch.hpp"

namespace dead_ends {

struct Person {
    std::uint64_t seed = 0;
    std::string assembly = "cover-m8";
    std::string variant;
    play::CourseOptions course;
    std::string tool;       // empty: the usual one
    double sets = 1.0;      // a torque wrench to this share of what is right
    bool at_mouse = true;   // else at a device: poses and grips
    double span = 10.0;     // s of doing anything
    bool rough = false;     // pulls at one nut for long, and hard
    bool overdoes = false;  // knows how it is done, and not when it is enough
};

// Anybody, by their number. The same number is the same person.
Person person(std::uint64_t seed);
std::string describe(const Person& person);

struct Life {
    std::vector<std::string> troubles;  // none: all is well
    double random_time = 0.0, rescue_time = 0.0;
    int restarts = 0;  // of steps, that the rescue needed
    bool done_by_random = false;
};

Life live(const Person& person, const content::Assembly& assembly, Met& met);

// The assembly of a person, with a lesson of not more than a few joints.
content::Assembly assembly_of(const Person& person);

}  // namespace dead_ends
