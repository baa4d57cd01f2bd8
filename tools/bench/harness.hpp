// What benchmarks of the engine share: values or an end, and clocks.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::bench {

using Clock = std::chrono::steady_clock;

inline double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// What all threads of this program have computed so far: unlike time, no other program adds to it.
inline double cpu_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Thrown out of a benchmark, where guarded() catches it.
template <class T>
T need(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message());
    return std::move(*result);
}
inline void need(const Status& status) {
    if (!status) throw std::runtime_error(status.error().message());
}

// What fails is said beside the benchmark's name; the others run on.
template <class Run>
void guarded(benchmark::State& state, const Run& run) {
    try {
        run();
    } catch (const std::exception& problem) {
        state.SkipWithError(problem.what());
    }
}

// What one thread has worked on something, and how such times are spread.

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
