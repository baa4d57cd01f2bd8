// The time as a device's line has it, and waiting in it: the machine's own, or one that stands until somebody
// waits in it, so that hours pass in seconds and every run is the same.
#pragma once

#include <functional>

namespace bolt::device {

struct Timer {
    std::function<double()> now;  // s, never goes back
    std::function<void(double seconds)> wait;
};

Timer steady_timer();

struct VirtualTime {
    double now = 0.0;  // s
};

Timer timer_of(VirtualTime& time);  // which outlives it

}  // namespace bolt::device
