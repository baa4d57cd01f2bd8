// Waits for effects of other processes, independent of the machine's load.
#pragma once

#include <chrono>
#include <thread>

namespace bolt::test {

// Polls every 10 ms until `test` returns true. Returns false after 12,000 polls, or after ten minutes.
template <class Test>
bool eventually(const Test& test) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(10);
    for (int i = 0; i < 12000 && std::chrono::steady_clock::now() < end; ++i) {
        if (test()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace bolt::test
