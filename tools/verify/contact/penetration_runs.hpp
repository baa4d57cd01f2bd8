// Motions of a hand through obstacles, and the greatest depth of the wrench that the god-object holds back,
// by the contact oracle.
#pragma once

#include <string>

#include "haptics/servo/tick.hpp"
#include "tools/verify/contact/scene.hpp"

namespace bolt::contact_validation {

struct PenetrationRun {
    std::string name;
    std::size_t ticks = 0, touching = 0, crossing = 0;
    // m, the greatest; depths above 60 um are resolved to 10 um.
    double depth = 0.0;
    collision::ObstacleId in{};  // the obstacle, there
    Pose tool{};                 // there
};

// From one free pose to another through everything, 1.5 s each. The hexagon of a nut that the jaw sits on
// counts as turned with it beyond the play, as the tick has it (servo/touch.hpp).
PenetrationRun pulled_through(const servo::Setup& setup, servo::State& state, const Scene& scene,
                              std::uint64_t seed, int ways);

// Onto random nuts, misaligned: offset, turned, tilted, pressed on, twisted, pulled off.
PenetrationRun at_nuts(const servo::Setup& setup, servo::State& state, const Scene& scene, std::uint64_t seed,
                       int times);

// The god-object with this tool alone. Flicked at 2 m/s through a rib of 1 mm.
Result<PenetrationRun> flicked(const collision::ToolShape& tool, const proxy::GodObjectParameters& parameters,
                               std::uint64_t seed, int times);

// The jaw's end in a slot that is 1 mm wider than the jaw is thick (m), pulled about at up to 1 m/s.
Result<PenetrationRun> in_a_slot(const collision::ToolShape& tool,
                                 const proxy::GodObjectParameters& parameters, double thickness,
                                 std::uint64_t seed, int ticks);

std::string to_text(const PenetrationRun& run);

}  // namespace bolt::contact_validation
