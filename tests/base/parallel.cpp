#include "engine/base/parallel.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

TEST_CASE("Parallel work: each index is handled once, by as many threads as there are processors") {
    for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
        std::vector<int> calls(count, 0);
        bolt::for_each_in_parallel(count, [&](std::size_t i) { ++calls[i]; });
        CHECK(std::all_of(calls.begin(), calls.end(), [](int n) { return n == 1; }));
    }
    // Each call waits until as many run as there are processors: with fewer threads this would never end.
    const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
    std::atomic<std::size_t> running{0};
    bolt::for_each_in_parallel(processors, [&](std::size_t) {
        ++running;
        while (running < processors) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    CHECK(running == processors);
}
