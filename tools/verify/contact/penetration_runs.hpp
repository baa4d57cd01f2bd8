// Moves a simulated hand through obstacles and measures, with the contact oracle, how deep the wrench
// penetrates them under the god-object.
#pragma once

#include <string>

#include "haptics/servo/tick.hpp"
#include "tools/verify/contact/scene.hpp"

namespace bolt::contact_validation {

struct PenetrationRun {
    std::string name;
    std::size_t ticks = 0;
    std::size_t checked = 0;           // ticks near an obstacle, which the oracle checked
    std::size_t crossing = 0;          // checked ticks in which the surfaces crossed
    double depth = 0.0;                // m, greatest penetration; depths above 60 um are resolved to 10 um
    collision::ObstacleId obstacle{};  // the obstacle with that depth
    Pose tool{};                       // the pose of the wrench at that depth
};

// `motions` straight motions between random free poses, through anything that lies between, 1.5 s each.
// Beyond the play, the hexagon of the nut in the jaw is assumed to turn with the jaw, as in
// haptics/servo/tool_contact.hpp.
PenetrationRun run_through_obstacles(const servo::Setup& setup, servo::State& state,
                                     const ContactScene& scene, std::uint64_t seed, int motions);

// `times` misaligned approaches to random nuts: offset, turned, tilted, pressed on, twisted and pulled off.
PenetrationRun run_onto_nuts(const servo::Setup& setup, servo::State& state, const ContactScene& scene,
                             std::uint64_t seed, int times);

// The god-object with this tool alone, moved at 2 m/s through a rib of 1 mm.
Result<PenetrationRun> run_flicks(const collision::ToolShape& tool,
                                  const proxy::GodObjectParameters& parameters, std::uint64_t seed,
                                  int times);

// The end of the wrench with the jaw in a slot 1 mm wider than the jaw's `thickness` (m), moved at random at
// up to 1 m/s.
Result<PenetrationRun> run_in_slot(const collision::ToolShape& tool,
                                   const proxy::GodObjectParameters& parameters, double thickness,
                                   std::uint64_t seed, int ticks);

std::string to_text(const PenetrationRun& run);

}  // namespace bolt::contact_validation
