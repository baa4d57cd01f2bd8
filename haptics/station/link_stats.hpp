// Statistics of the data between a device and the servo, counted by the servo's ticks.
#pragma once

#include <algorithm>

#include "haptics/station/tick.hpp"

namespace bolt::station {

struct LinkStats {
    std::uint64_t samples = 0;
    double silence = 0.0, longest_silence = 0.0;       // s since the last sample, valid or not
    double largest_force = 0.0, largest_torque = 0.0;  // N, N·m, that were sent
};

// Call after each tick with the device's link and the command that was sent.
inline void count(LinkStats& stats, const DeviceLink& link, const force::OutputCommand& sent) {
    stats.samples = link.number;
    stats.silence = link.silence;
    stats.longest_silence = std::max(stats.longest_silence, link.silence);
    stats.largest_force = std::max(stats.largest_force, glm::length(sent.force));
    stats.largest_torque = std::max(stats.largest_torque, glm::length(sent.torque));
}

struct StationLinkStats {
    LinkStats mover, wheel;
};

}  // namespace bolt::station
