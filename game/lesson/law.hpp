// The targets of an assembly's joints under each joint law.
#pragma once

#include <cstdint>

#include "content/format/assembly.hpp"
#include "haptics/joint/law.hpp"

namespace bolt::lesson {

// Selects how apply_law() adapts an assembly: as now, or as programs did before format 6 of session files.
// Replays and reports of such files need the latter.
enum class LawAdaptation : std::uint8_t { yield_end, before_format_6 };

// Returns the assembly with `law` in force and its specifications adapted to it. The specifications of joint
// types hold under the mechanistic law. Under the published law the torque of a joint stops growing at its
// T_max (haptics/joint/published.hpp), so these targets replace them:
//   - the joint's own published targets, if the file has them
//   - otherwise targets in the last third of the yield stage. Because the torque stops growing there, it is
//   the nut's angle that can be too high: its window ends a third of the yield stage's width beyond that
//   stage
// A torque wrench is set so low that it clicks before the end of the yield stage, whatever its deviation. If
// that lowers the target torque, the lower torque limit stays below the lowest torque at which the wrench can
// click. The target clamp force follows from the target torque. Without θ_max in the file, θ_max is computed
// for a nut that starts at design.start_gap. `before_format_6`: without own targets, the target torque is at
// most 98 % of T_max, and the lower limit at most 95 % of the target; no angle is judged; θ_max and the
// torque wrench are not adapted. Idempotent.
content::Assembly apply_law(content::Assembly assembly, joint::Law law,
                            LawAdaptation adaptation = LawAdaptation::yield_end);

}  // namespace bolt::lesson
