// What a help does: lessons with it beside the same lessons without it.
#pragma once

#include <span>
#include <string>

#include "game/report/attempts.hpp"

namespace bolt::report {

// A part for each set of attempts that differ in nothing but the guiding and the seed, in the order of the
// first of each; nothing if there is no such set with both.
std::string guiding_study(std::span<const Attempt> attempts);

// The same of the help with the view, by simulated trainees.
std::string view_study(std::span<const Attempt> attempts);

}  // namespace bolt::report
