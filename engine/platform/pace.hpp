// Frame pacing. Presentation does not always limit the frame rate (not in mailbox mode, not under Xvfb), so
// the program limits it. Deadlines are a whole number of periods after the start; a late frame does not move
// them.
#pragma once

#include <chrono>
#include <cstdint>

namespace bolt::platform {

using Clock = std::chrono::steady_clock;

// Deadlines are at start + index · period.
struct Pace {
    Clock::time_point start{};
    double period = 1.0 / 60.0;  // s
    std::uint64_t index = 0;     // of the last deadline
};

struct FrameDeadline {
    Clock::time_point time;
    std::uint64_t missed = 0;  // earlier deadlines that were skipped
};

// Returns the next deadline that has not passed, and advances `pace` to it. After a frame that took too long,
// missed deadlines are skipped, not caught up on. `now` must not be before the start.
FrameDeadline next_deadline(Pace& pace, Clock::time_point now);

// Returns the period of a display with this refresh rate in Hz; 1/60 s if the rate is implausible.
double period_of(double refresh);

// Waits for the next deadline. Returns how many deadlines were skipped.
std::uint64_t wait_for_deadline(Pace& pace);

}  // namespace bolt::platform
