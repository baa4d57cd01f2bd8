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
    if (d.sensing == device::Sensing::velocity) return finite(s.velocity) && finite(s.angular_velocity);
    if (d.sensing == device::Sensing::angle) return std::isfinite(s.angle);
    return finite(s.pose.position) && std::abs(glm::dot(s.pose.orientation, s.pose.orientation) - 1.0) < 1e-6;
}

inline void check_description(const device::Description& d) {
    CHECK_FALSE(d.name.empty());
    CHECK_FALSE(d.id.empty());
    CHECK(d.rate >= 1.0);
    CHECK(d.rate <= 20'000.0);
    CHECK(std::abs(glm::length(d.axis) - 1.0) < 1e-9);
    CHECK(glm::min(d.half_workspace.x, glm::min(d.half_workspace.y, d.half_workspace.z)) >= 0.0);
    CHECK(d.buttons >= 0);
    CHECK(d.buttons <= 32);
    // A component is rendered if and only if it has a nonzero limit.
    CHECK((d.renders[0] || d.renders[1] || d.renders[2]) == (d.limits.force > 0.0));
    CHECK((d.renders[3] || d.renders[4] || d.renders[5]) == (d.limits.torque > 0.0));
    CHECK(d.limits.delay >= 0);
    CHECK(d.limits.delay <= 3);
}

// `move_device` makes the device send a sample, as the hand of a user does.
template <class MoveDevice>
void check_driver_contract(const device::DeviceFactory& open, const MoveDevice& move_device) {
    for (int plugged = 0; plugged < 2; ++plugged) {  // the device can be reopened
        Result<std::unique_ptr<device::DeviceDriver>> opened = open();
        REQUIRE(opened);
        device::DeviceDriver& device = **opened;
        const device::Description description = device.description();
        check_description(description);
        CHECK(device.description().id == description.id);
        int samples = 0;
        for (int i = 0; i < 1000 && samples < 3; ++i) {
            move_device();
            const Result<std::optional<device::Sample>> read = device.read(0.005);
            REQUIRE(read);
            if (!*read) continue;
            CHECK(is_valid(description, **read));
            ++samples;
        }
        CHECK(samples == 3);
        const force::OutputCommand most{Vec3(description.limits.force, 0, 0),
                                        description.axis * description.limits.torque};
        CHECK(device.write(most));
        CHECK(device.write({}));
        CHECK(device.read(0.0));  // a zero timeout returns too
    }
}

// `pull` unplugs the device. Reads or writes must then fail within 1000 calls, and the error of open() must
// name a remedy.
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

// A timer that advances an emulated arm. Both arguments must outlive it; `advance` may be set later.
inline device::Timer advancing_timer(double& now, void (*const& advance)(double seconds)) {
    return {[&now] { return now; },
            [&now, &advance](double seconds) {
                now += std::max(seconds, 0.0);
                advance(std::max(seconds, 0.0));
            }};
}

}  // namespace bolt::test
