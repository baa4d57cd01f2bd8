#include "engine/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace bolt {

void for_each_in_parallel(std::size_t count, FunctionRef<void(std::size_t)> work, std::size_t threads) {
    if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
    std::atomic<std::size_t> next{0};
    const auto take_turns = [&]() noexcept {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::jthread> others;
    try {
        while (others.size() + 1 < std::min(threads, count)) others.emplace_back(take_turns);
    } catch (const std::system_error&) {
        // The threads that exist do all of the work.
    }
    take_turns();
}

}  // namespace bolt
