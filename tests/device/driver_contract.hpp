// The contract that all drivers share and the rest of the program relies on. The test of a driver calls these
// functions and adds its own checks.
#pragma once

#include <doctest/doctest.h>

#include <cmath>

#include "haptics/device/device.hpp"

namespace bolt::test {

inline bool is_valid(const device::Description& d, const device::Sample& s) {
    const auto finite = [](const Vec3& v) {
        return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    if (d.sensing == device::Sensing::rate) return finite(s.velocity) && finite(s.angular_velocity);
    if (d.sensing == device::Sensing::turn) return std::isfinite(s.turn);
    return finite(s.pose.position) && std::abs(glm::dot(s.pose.orientation, s.pose.orientation) - 1.0) < 1e-6;
}

inline void check_description(const device::Description& d) {
    CHECK_FALSE(d.name.empty());
    CHECK_FALSE(d.id.empty());
    CHECK(d.rate >= 1.0);
    CHECK(d.rate <= 20'000.0);
    CHECK(std::abs(glm::length(d.axis) - 1.0) < 1e-9);
    CHECK(glm::min(d.reach.x, glm::min(d.reach.y, d.reach.z)) >= 0.0);
    CHECK(d.buttons >= 0);
    CHECK(d.buttons <= 32);
    // A component is rendered if and only if it has a nonzero limit.
    CHECK((d.renders[0] || d.renders[1] || d.renders[2]) == (d.limits.force > 0.0));
    CHECK((d.renders[3] || d.renders[4] || d.renders[5]) == (d.limits.torque > 0.0));
    CHECK(d.limits.delay >= 0);
    CHECK(d.limits.delay <= 3);
}

// `speaks` makes the device send a sample, as a hand on it would.
template <class Speaks>
void check_driver_contract(const device::DeviceFactory& open, const Speaks& speaks) {
    for (int plugged = 0; plugged < 2; ++plugged) {  // the device can be reopened
        Result<std::unique_ptr<device::DeviceDriver>> opened = open();
        REQUIRE(opened);
        device::DeviceDriver& device = **opened;
        const device::Description description = device.describe();
        check_description(description);
        CHECK(device.describe().id == description.id);
        int heard = 0;
        for (int i = 0; i < 1000 && heard < 3; ++i) {
            speaks();
            const Result<std::optional<device::Sample>> read = device.read(0.005);
            REQUIRE(read);
            if (!*read) continue;
            CHECK(is_valid(description, **read));
            ++heard;
        }
        CHECK(heard == 3);
        const force::OutputCommand most{Vec3(description.limits.force, 0, 0),
                                        description.axis * description.limits.torque};
        CHECK(device.write(most));
        CHECK(device.write({}));
        CHECK(device.read(0.0));  // a zero timeout returns too
    }
}

// `pull` unplugs the device. Reads or writes then fail soon, and the error of open() says what to do.
template <class Pull>
void check_unplugged(const device::DeviceFactory& open, const Pull& pull) {
    Result<std::unique_ptr<device::DeviceDriver>> opened = open();
    REQUIRE(opened);
    pull();
    bool gone = false;
    for (int i = 0; i < 1000 && !gone; ++i) gone = !(*opened)->read(0.005) || !(*opened)->write({});
    CHECK(gone);
    opened->reset();  // the destructor returns without a device
    const Result<std::unique_ptr<device::DeviceDriver>> again = open();
    REQUIRE_FALSE(again);
    CHECK(again.error().code == ErrorCode::no_device);
    CHECK_FALSE(again.error().expected.empty());
}

}  // namespace bolt::test
