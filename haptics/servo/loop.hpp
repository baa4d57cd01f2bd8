// A loop of fixed period around a tick, on any clock. Deadlines are whole periods after the start; nothing
// that is late moves them, and none is made up for: two ticks in a hurry would be one jerk of the hand.
#pragma once

#include <algorithm>
#include <cstdint>

#include "haptics/servo/timing.hpp"

namespace bolt::servo {

struct Beat {
    std::uint64_t number = 0;  // of the deadline: counts missed ones too
    std::uint64_t missed = 0;  // deadlines since the tick before that passed without one
};

// `clock` has now() and sleep_until(deadline), both in ns of a clock that never goes back; `tick` takes the
// beat and returns whether to go on; `publish` sees the timing after every tick. The loop always sleeps
// before a tick, even if the next deadline is near: a real-time thread that never sleeps is stopped by the
// kernel for 50 ms.
template <class Clock, class Tick, class Publish>
void run_loop(Clock& clock, std::int64_t period, Timing& timing, Tick&& tick, Publish&& publish) {
    const std::int64_t start = clock.now();
    std::int64_t woken_before = start;
    std::uint64_t number = 0;  // of the last deadline that had a tick
    for (bool go_on = true; go_on;) {
        // The first deadline that is still to come.
        const std::int64_t now = clock.now();
        const auto next = std::max(static_cast<std::uint64_t>((now - start) / period), number) + 1;
        const Beat beat{next, next - number - 1};
        const std::int64_t deadline = start + static_cast<std::int64_t>(next) * period;
        clock.sleep_until(deadline);
        const std::int64_t woken = clock.now();
        go_on = tick(beat);
        const std::int64_t done = clock.now();
        add(timing.wake_up, woken - deadline);
        add(timing.compute, done - woken);
        if (timing.ticks > 0) add(timing.period, woken - woken_before);
        ++timing.ticks;
        timing.missed += beat.missed;
        number = next;
        woken_before = woken;
        publish(timing);
    }
}

}  // namespace bolt::servo
