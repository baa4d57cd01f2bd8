// Everything that is felt goes through here, and nothing else writes to a device:
//
//   watchdog    may anything be rendered?            watchdog.hpp
//   passivity   observer, then controller            passivity.hpp
//   limiter     ramp, slew limit, clamp, release     limiter.hpp
#pragma once

#include "haptics/force/limiter.hpp"
#include "haptics/force/passivity.hpp"
#include "haptics/force/watchdog.hpp"

namespace bolt::force {

struct OutputStage {
    WatchdogState watchdog;
    PassivityState passivity;
    OutputState output;
};

// One tick of dt. Returns what goes to the device. Within limits.release of the dead-man being let go, of the
// last sample, or of any other fault, that is nothing.
OutputCommand render(const OutputLimits& limits, OutputStage& stage, const PortInput& input,
                     const Wanted& wanted, double dt);

}  // namespace bolt::force
