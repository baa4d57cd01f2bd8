// boltwright doctor --device …: a station that is started, looked at for a while, and judged.
#pragma once

#include <string>
#include <vector>

namespace bolt::cli {

struct StationOptions {
    std::string assembly = "zq350";
    std::vector<std::string> devices;
    std::string rig, glove, trainee, calibrations;
    double seconds = 5.0;

    [[nodiscard]] bool any() const { return !devices.empty() || !glove.empty(); }
};

// Says what happens and returns the exit code: 0 it is good enough to train with, 1 it ran and is not, or why
// it could not begin.
int try_station(const StationOptions& options);

// For whoever has not named one; empty: there is none to try.
std::string what_to_try();

}  // namespace bolt::cli
