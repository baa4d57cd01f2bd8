#include "haptics/device/list.hpp"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace bolt::device;

TEST_CASE("the threads of several devices look for them at the same time") {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([] {
            const Open open = opener("0000:0000:nothing");
            for (int n = 0; n < 500; ++n) {
                list(true);
                open();
            }
        });
    threads.clear();
    CHECK(!opener("0000:0000:nothing")());
}
