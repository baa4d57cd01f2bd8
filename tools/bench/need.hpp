// What benchmarks of the engine share: values or an end, and clocks.
#pragma once

#include <benchmark/benchmark.h>

#include <chrono>
#include <ctime>
#include <stdexcept>

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

}  // namespace bolt::bench
