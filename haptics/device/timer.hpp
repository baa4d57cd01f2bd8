// A clock and a wait function for device threads: the machine's steady clock, or virtual time that advances
// only by waiting, so that tests are fast and repeatable.
#pragma once

#include <functional>

namespace bolt::device {

struct Timer {
    std::function<double()> now;  // s, monotonic
    std::function<void(double seconds)> wait;
};

Timer steady_timer();

struct VirtualTime {
    double now = 0.0;  // s
};

Timer virtual_timer(VirtualTime& time);  // `time` must outlive the timer

}  // namespace bolt::device
