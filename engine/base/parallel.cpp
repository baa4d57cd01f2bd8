#include "engine/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

namespace bolt {

void for_each_in_parallel(std::size_t count, FunctionRef<void(std::size_t)> work) {
    std::atomic<std::size_t> next{0};
    const auto take_turns = [&]() noexcept {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::jthread> others;
    const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
    try {
        while (others.size() + 1 < std::min(processors, count)) others.emplace_back(take_turns);
    } catch (const std::system_error&) {
        // The threads that exist do all of the work.
    }
    take_turns();
}

}  // namespace bolt
