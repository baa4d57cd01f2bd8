// How a servo loop kept its time, and whether a host that keeps it so is good enough to be felt.
#pragma once

#include <string>
#include <vector>

#include "haptics/servo/histogram.hpp"

namespace bolt::servo {

struct Timing {
    Histogram wake_up;  // from the deadline to the loop running again
    Histogram compute;  // the tick
    Histogram period;   // from one waking to the next
    std::uint64_t ticks = 0;
    std::uint64_t missed = 0;  // deadlines that passed while something else ran: skipped, never made up for
};

// What the operating system gave the thread of what it asked for.
struct Granted {
    int priority = 0;            // of SCHED_FIFO; 0: it shares the processor like any other thread
    bool memory_locked = false;  // no page of this process is ever fetched from disk
    bool flushes_denormals = false;
    std::vector<std::string> refused;  // in words: what was not given, why, and what would help
};

// Above these a hand may feel the loop, or a device's own watchdog may let go. Shares are of a period.
struct HostLimits {
    double wake_up = 0.25;       // at the 99.9th percentile
    double compute = 0.5;        // at the 99.9th percentile: the rest is for the device's transfer
    double missed = 1e-3;        // of all deadlines
    double stall = 0.02;         // s without a tick: the output stage is to be at zero by then
    std::uint64_t ticks = 1000;  // fewer say nothing about a 99.9th percentile
};

struct Verdict {
    bool good = false;
    std::vector<std::string> reasons;  // each a measured value beside its limit, worst news first
    std::size_t against = 0;           // so many of them, the first, say that it is not
};

// At `rate` (1/s), which need not be the one at which the timing was taken: what was late by more than a
// period of `rate` would have missed deadlines there.
Verdict judge_host(const Timing& timing, double rate, const HostLimits& limits = {});

// Rows of text: one a histogram (median, p99, p99.9, greatest), then ticks and what was missed.
std::string describe(const Timing& timing);

}  // namespace bolt::servo
