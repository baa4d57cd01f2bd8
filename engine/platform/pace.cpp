#include "engine/platform/pace.hpp"

#include <cmath>
#include <thread>

namespace bolt::platform {

namespace {

// Multiplied out anew each time: sums of rounded periods would drift.
Clock::time_point deadline(const Pace& pace, std::uint64_t beat) {
    const std::chrono::duration<double> after(static_cast<double>(beat) * pace.period);
    return pace.start + std::chrono::round<Clock::duration>(after);
}

}  // namespace

Due next_due(Pace& pace, Clock::time_point now) {
    const std::uint64_t expected = pace.beat + 1;
    const std::chrono::duration<double> passed = now - pace.start;
    std::uint64_t beat = expected;
    if (deadline(pace, beat) < now) {
        beat = std::max(beat, static_cast<std::uint64_t>(passed.count() / pace.period));
        while (deadline(pace, beat) < now) ++beat;
    }
    pace.beat = beat;
    return {deadline(pace, beat), beat - expected};
}

double period_of(double refresh) { return 1.0 / (refresh >= 20.0 && refresh <= 1000.0 ? refresh : 60.0); }

std::uint64_t wait_for_due(Pace& pace) {
    const Due due = next_due(pace, Clock::now());
    std::this_thread::sleep_until(due.deadline);
    return due.missed;
}

}  // namespace bolt::platform
