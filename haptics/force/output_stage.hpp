// All forces pass through this stage; nothing else writes to a device.
//
//   watchdog    permits or blocks the output         watchdog.hpp
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

// One tick of dt. Returns the device's command. It is zero at most limits.release after the dead-man switch
// is released, after the last sample of a silent device, and after any other fault.
OutputCommand render(const OutputLimits& limits, OutputStage& stage, const PortInput& input,
                     const ForceRequest& request, double dt);

}  // namespace bolt::force
