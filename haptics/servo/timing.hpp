// Timing statistics of a servo loop, and the assessment of a host from them.
#pragma once

#include <string>
#include <vector>

#include "haptics/servo/histogram.hpp"

namespace bolt::servo {

struct Timing {
    Histogram wake_up;  // from the deadline until the loop runs
    Histogram compute;  // duration of the tick
    Histogram period;   // from one wake-up to the next
    std::uint64_t ticks = 0;
    std::uint64_t missed = 0;  // deadlines that were skipped because the loop did not run in time
};

// The real-time privileges that the operating system granted to the thread.
struct ThreadPrivileges {
    int priority = 0;            // of SCHED_FIFO; 0: ordinary scheduling
    bool memory_locked = false;  // no page of this process can be swapped out
    bool flushes_denormals = false;
    std::vector<std::string> refused;  // one message per refused privilege, with the reason and the remedy
};

// Limits above which a hand may feel the loop's jitter or a device's own watchdog may trip. wake_up and
// compute are shares of the period.
struct HostRequirements {
    double wake_up = 0.25;  // at the 99.9th percentile
    double compute =
        0.5;  // at the 99.9th percentile; the rest of the period is for the transfer to the device
    double missed = 1e-3;        // share of all deadlines
    double stall = 0.02;         // s without a tick; the output stage must have reached zero by then
    std::uint64_t ticks = 1000;  // fewest ticks that give a 99.9th percentile
};

struct HostAssessment {
    bool adequate = false;
    std::vector<std::string> reasons;  // a measured value with its limit each, violated limits first
    std::size_t violations = 0;        // number of violated limits
};

// `rate` (1/s) may differ from the rate at which the timing was measured: a wake-up later than a period of
// `rate` counts as a missed deadline.
HostAssessment assess_host(const Timing& timing, double rate, const HostRequirements& requirements = {});

// A table: one row per histogram (median, p99 and p99.9 in µs, greatest in ms), then ticks and missed
// deadlines.
std::string describe(const Timing& timing);

}  // namespace bolt::servo
