// The driver of OpenHaptics' arms on an emulated library, in virtual time.
#pragma once

#include <doctest/doctest.h>

#include <array>

#include "haptics/device/open_haptics.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/support/emulated_arms.hpp"

namespace bolt::test {

// An emulated arm whose clock is the driver's.
struct OpenHapticsBench {
    device::OpenHapticsApi api;
    OpenHapticsControls arm;
    double now = 0.0;
    device::Timer timer = advancing_timer(now, arm.advance);

    OpenHapticsBench() {
        const auto loaded = device::load_open_haptics({BOLT_EMULATED_OPEN_HAPTICS});
        REQUIRE_MESSAGE(loaded, (loaded ? "" : loaded.error().message()));
        api = *loaded;
        arm.reset();
    }
    OpenHapticsBench(const OpenHapticsBench&) = delete;
    OpenHapticsBench& operator=(const OpenHapticsBench&) = delete;
    ~OpenHapticsBench() { arm.reset(); }

    Result<std::unique_ptr<device::DeviceDriver>> open() { return device::open_open_haptics(api, timer); }
    std::unique_ptr<device::DeviceDriver> opened() {
        auto device = open();
        REQUIRE_MESSAGE(device, (device ? "" : device.error().message()));
        return std::move(*device);
    }
    // Reads for `seconds`, and returns the last sample.
    device::Sample read(device::DeviceDriver& device, double seconds) {
        device::Sample last;
        for (const double until = now + seconds; now < until;) {
            const auto sample = device.read(0.005);
            REQUIRE_MESSAGE(sample, (sample ? "" : sample.error().message()));
            if (*sample) last = **sample;
        }
        return last;
    }
    // Writes `command` each millisecond and reads; whether the device still works after `seconds`.
    bool drive(device::DeviceDriver& device, const force::OutputCommand& command, double seconds) {
        for (const double until = now + seconds; now < until;) {
            if (!device.write(command)) return false;
            const double next = now + 1e-3;
            while (now < next)
                if (!device.read(next - now)) return false;
        }
        return true;
    }
    [[nodiscard]] std::array<double, 6> wrench_now() const {
        std::array<double, 6> wrench{};
        arm.force(wrench.data());
        return wrench;
    }
    [[nodiscard]] Vec3 force_vector() const {
        const auto wrench = wrench_now();
        return {wrench[0], wrench[1], wrench[2]};
    }
    [[nodiscard]] double force_now() const { return glm::length(force_vector()); }
    [[nodiscard]] Vec3 torque_now() const {
        const auto wrench = wrench_now();
        return {wrench[3], wrench[4], wrench[5]};
    }
};

inline const force::OutputCommand two_newton{Vec3(0, 2, 0), {}};

}  // namespace bolt::test
