// When the next frame is due. Presenting does not pace a program everywhere (not in a mailbox, not under
// Xvfb), so the program does: deadlines are whole periods after one start, and nothing that is late moves
// them.
#pragma once

#include <chrono>
#include <cstdint>

namespace bolt::platform {

using Clock = std::chrono::steady_clock;

// Deadlines are start + beat · period.
struct Pace {
    Clock::time_point start{};
    double period = 1.0 / 60.0;  // s
    std::uint64_t beat = 0;      // of the last deadline
};

struct Due {
    Clock::time_point deadline;
    std::uint64_t missed = 0;  // deadlines that passed unused before it
};

// The next deadline that is not over, and the pace with it. A frame that took too long costs the beats that
// it slept through: the next one is on a beat again, and none is made up for in a hurry. `now` is not before
// the start.
Due next_due(Pace& pace, Clock::time_point now);

// Period of a display that shows `refresh` pictures a second; 60 where it says nothing sensible.
double period_of(double refresh);

// Waits for the next deadline; returns how many were missed.
std::uint64_t wait_for_due(Pace& pace);

}  // namespace bolt::platform
