#include "haptics/device/connected_devices.hpp"

#include <doctest/doctest.h>

#include <thread>
#include <vector>

using namespace bolt::device;

TEST_CASE("HidDevices: several threads can enumerate at the same time") {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([] {
            const DeviceFactory open = factory_for("0000:0000:nothing");
            for (int n = 0; n < 500; ++n) {
                list_devices(true);
                open();
            }
        });
    threads.clear();
    CHECK(!factory_for("0000:0000:nothing")());
}
