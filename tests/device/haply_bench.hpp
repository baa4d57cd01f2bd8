// The driver of Haply's Inverse3 and an emulated service, both with threads of their own.
#pragma once

#include <doctest/doctest.h>

#include "haptics/device/haply.hpp"
#include "tools/emulate/arms/haply.hpp"

namespace bolt::test {

struct HaplyBench {
    std::unique_ptr<emulate::EmulatedHaply> arm;
    device::HaplyService service;

    explicit HaplyBench(const emulate::EmulatedHaplyOptions& options = {}) {
        auto started = emulate::EmulatedHaply::start(options);
        REQUIRE_MESSAGE(started, (started ? "" : started.error().message()));
        arm = std::move(*started);
        service.states.port = arm->port();
        service.events.port = static_cast<std::uint16_t>(arm->port() + 19);
    }
    [[nodiscard]] Result<std::unique_ptr<device::DeviceDriver>> open(int index = 0) const {
        return device::open_haply(service, index, device::steady_timer());
    }
    [[nodiscard]] Error error_of_opening() const {
        const auto opened = open();
        REQUIRE_FALSE(opened);
        return opened.error();
    }
};

}  // namespace bolt::test
