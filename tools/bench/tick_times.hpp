// What one thread has worked on something, and how such times are spread.
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

namespace bolt::bench {

// Of this thread's own work, whatever else runs.
inline double thread_microseconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

// What `share` of the values are below.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0.0;
    const auto last = values.size() - 1;
    const auto at = std::min(last, static_cast<std::size_t>(share * static_cast<double>(values.size())));
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(at), values.end());
    return values[at];
}

}  // namespace bolt::bench
