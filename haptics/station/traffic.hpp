// What passes between a device and the servo, as the servo sees it: for whoever asks whether a station works.
#pragma once

#include <algorithm>

#include "haptics/station/step.hpp"

namespace bolt::station {

struct Traffic {
    std::uint64_t samples = 0;
    // s by the servo's ticks, of sense or not: since the newest sample, and the longest without any.
    double silent = 0.0, longest_silence = 0.0;
    double force = 0.0, torque = 0.0;  // N, N·m: the most that was sent
};

// After a tick: what is known of the device then, and what it was sent.
inline void count(Traffic& traffic, const Port& port, const force::OutputCommand& sent) {
    traffic.samples = port.number;
    traffic.silent = port.quiet;
    traffic.longest_silence = std::max(traffic.longest_silence, port.quiet);
    traffic.force = std::max(traffic.force, glm::length(sent.force));
    traffic.torque = std::max(traffic.torque, glm::length(sent.torque));
}

struct Passed {
    Traffic mover, wheel;
};

}  // namespace bolt::station
