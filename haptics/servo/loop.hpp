// A loop that calls a tick at a fixed period, on any clock. Deadlines are whole periods after the start and
// never shift. A missed deadline is skipped: two ticks in quick succession would be felt as a jerk.
#pragma once

#include <algorithm>
#include <cstdint>

#include "haptics/servo/timing.hpp"

namespace bolt::servo {

struct Deadline {
    std::uint64_t number = 0;  // counts all deadlines, missed ones too
    std::uint64_t missed = 0;  // deadlines without a tick since the last tick
};

// `clock` has now() and sleep_until(deadline), in ns of a monotonic clock. `tick` takes a Deadline and
// returns false to end the loop. `publish` gets the timing after every tick. The loop sleeps before every
// tick, even if the deadline is near: the kernel suspends a real-time thread that never sleeps for 50 ms of
// each second (sched_rt_runtime_us).
template <class Clock, class Tick, class Publish>
void run_loop(Clock& clock, std::int64_t period, Timing& timing, Tick&& tick, Publish&& publish) {
    const std::int64_t start = clock.now();
    std::int64_t woken_before = start;
    std::uint64_t number = 0;  // of the last deadline with a tick
    for (bool running = true; running;) {
        const std::int64_t now = clock.now();
        const auto next = std::max(static_cast<std::uint64_t>((now - start) / period), number) + 1;
        const Deadline deadline{next, next - number - 1};
        const std::int64_t due = start + static_cast<std::int64_t>(next) * period;
        clock.sleep_until(due);
        const std::int64_t woken = clock.now();
        running = tick(deadline);
        const std::int64_t done = clock.now();
        add(timing.wake_up, woken - due);
        add(timing.compute, done - woken);
        if (timing.ticks > 0) add(timing.period, woken - woken_before);
        ++timing.ticks;
        timing.missed += deadline.missed;
        number = next;
        woken_before = woken;
        publish(timing);
    }
}

}  // namespace bolt::servo
