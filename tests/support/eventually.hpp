// Waits for effects of other processes, independent of the machine's load.
#pragma once

#include <chrono>
#include <thread>

namespace bolt::test {

// Polls until `test` returns true; returns false after two minutes.
template <class Test>
bool eventually(const Test& test) {
    for (int i = 0; i < 12000; ++i) {
        if (test()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace bolt::test
