// Helpers of the benchmarks: errors, clocks and quantiles.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <ctime>
#include <stdexcept>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"

namespace bolt::bench {

using WallClock = std::chrono::steady_clock;

inline double milliseconds_since(WallClock::time_point start) {
    return std::chrono::duration<double, std::milli>(WallClock::now() - start).count();
}

// CPU time of all threads of this process. Other programs do not affect it.
inline double cpu_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Returns the value, or throws the error, which run_or_skip() catches.
template <class T>
T unwrap(Result<T> result) {
    if (!result) throw std::runtime_error(result.error().message());
    return std::move(*result);
}
inline void unwrap(const Status& status) {
    if (!status) throw std::runtime_error(status.error().message());
}

// Runs a benchmark. An exception is reported under the benchmark's name, and the other benchmarks still run.
template <class Run>
void run_or_skip(benchmark::State& state, const Run& run) {
    try {
        run();
    } catch (const std::exception& problem) {
        state.SkipWithError(problem.what());
    }
}

// CPU time of this thread.
inline double thread_microseconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

using bolt::quantile;

}  // namespace bolt::bench
