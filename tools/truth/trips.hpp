// Ways of a hand that goes where no wrench can, and how far the wrench that the god-object holds back is
// truly inside something on them.
#pragma once

#include <string>

#include "haptics/servo/tick.hpp"
#include "tools/truth/scene.hpp"

namespace bolt::truth {

struct Trip {
    std::string name;
    std::size_t ticks = 0, touching = 0, crossing = 0;
    // m, the greatest seen; what is deeper than 60 um is known to 10 um.
    double depth = 0.0;
    std::int32_t in = -1;  // id of the obstacle, there
    Pose tool{};           // there
};

// Through everything from one free place to another, 1.5 s a way. The hexagon of a nut that the jaw sits on
// counts as turned with it beyond the play, as the tick has it (servo/touch.hpp).
Trip pulled_through(const servo::Setup& setup, servo::State& state, const Scene& scene, std::uint64_t seed,
                    int ways);

// Onto nut after nut, badly: beside it, turned, tilted, pressed on, turned about, pulled off.
Trip at_nuts(const servo::Setup& setup, servo::State& state, const Scene& scene, std::uint64_t seed,
             int times);

// The god-object with this tool alone. Flicked at 2 m/s through a rib of 1 mm.
Result<Trip> flicked(const contact::ToolShape& tool, const contact::GodObjectParameters& parameters,
                     std::uint64_t seed, int times);

// The jaw's end in a slot that is 1 mm wider than the jaw is thick (m), pulled about at up to 1 m/s.
Result<Trip> in_a_slot(const contact::ToolShape& tool, const contact::GodObjectParameters& parameters,
                       double thickness, std::uint64_t seed, int ticks);

std::string to_text(const Trip& trip);

}  // namespace bolt::truth
