// Waiting for what other processes do: a test passes when it happens, however long that takes on a busy
// machine.
#pragma once

#include <chrono>
#include <thread>

namespace bolt::test {

// Two minutes at most: then it does not happen.
template <class Test>
bool eventually(const Test& test) {
    for (int i = 0; i < 12000; ++i) {
        if (test()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

}  // namespace bolt::test
