// Minutes at the ZQ350 as a servo sees them: a simulated arm presses and slides the wrench along the casing,
// hits it, sweeps through rows of bolts, goes onto nuts and turns them, and gives way to what it feels.
#pragma once

#include <vector>

#include "engine/base/result.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::bench {

struct Servo {
    servo::Setup setup;
    servo::State state;
};

// How the device differs from the usual one.
struct Device {
    double dt = 1e-3;      // s, of a tick
    double encoder = 0.0;  // m, a step of it; 0: as fine as numbers are
    bool renders_torque = true;
};

Result<Servo> make_servo(const Device& device);

// The state at the beginning again, what is touched included.
void restart(Servo& servo);

// What the arm's device sends while the servo runs, for so many seconds. The same for the same seed.
std::vector<servo::Input> make_path(Servo& servo, const Device& device, double seconds, std::uint64_t seed);

}  // namespace bolt::bench
