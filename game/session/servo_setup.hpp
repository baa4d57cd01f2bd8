// An assembly as the servo sees it.
#pragma once

#include <cstdint>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::session {

// `law` may differ from the assembly's own.
servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt);

// Brings every joint to its target in the order of the last pass, by machine, and lets it rest: where a
// loosening lesson begins. Fails if a joint does not get there.
Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state);

}  // namespace bolt::session
