#include "engine/platform/pace.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace bolt::platform {

namespace {

// Multiplies, because a sum of rounded periods would drift.
Clock::time_point deadline_time(const Pace& pace, std::uint64_t index) {
    const std::chrono::duration<double> after(static_cast<double>(index) * pace.period);
    return pace.start + std::chrono::round<Clock::duration>(after);
}

}  // namespace

FrameDeadline next_deadline(Pace& pace, Clock::time_point now) {
    const std::uint64_t expected = pace.index + 1;
    const std::chrono::duration<double> passed = now - pace.start;
    std::uint64_t index = expected;
    if (deadline_time(pace, index) < now) {
        index = std::max(index, static_cast<std::uint64_t>(passed.count() / pace.period));
        while (deadline_time(pace, index) < now) ++index;
    }
    pace.index = index;
    return {deadline_time(pace, index), index - expected};
}

double period_of(double refresh) { return 1.0 / (refresh >= 20.0 && refresh <= 1000.0 ? refresh : 60.0); }

std::uint64_t wait_for_deadline(Pace& pace) {
    const FrameDeadline deadline = next_deadline(pace, Clock::now());
    std::this_thread::sleep_until(deadline.time);
    return deadline.missed;
}

}  // namespace bolt::platform
