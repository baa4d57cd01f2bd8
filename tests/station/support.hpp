// Devices of a station in virtual time. The work of all threads is done in turn, so every run is the same.
#pragma once

#include <optional>

#include "haptics/device/virtual_devices.hpp"
#include "haptics/station/station_tick.hpp"
#include "tests/device/support.hpp"
#include "tests/servo/support.hpp"

namespace bolt::test {

// A simulated device with its supervisor and mailboxes. until() does the work of its thread up to a time.
class VirtualLine {
  public:
    explicit VirtualLine(device::ScriptedDeviceOptions design)
        : thing(std::move(design), device::virtual_timer(time_)),
          supervisor_(thing.factory(), device::virtual_timer(time_)) {}

    device::ScriptedDevice thing;

    void until(double now) {
        while (time_.now < now) device::run_once(supervisor_, mailboxes_, snapshot_);
    }
    const device::DeviceSnapshot& snapshot() {
        mailboxes_.snapshots.update();
        return mailboxes_.snapshots.latest();
    }
    void command(const force::OutputCommand& command) {
        mailboxes_.commands.write({command, true, ++number_});
    }
    [[nodiscard]] const device::DeviceStatus& status() const { return supervisor_.status(); }
    [[nodiscard]] double now() const { return time_.now; }

  private:
    device::VirtualTime time_;

  public:
    device::DeviceSupervisor& supervisor() { return supervisor_; }

  private:
    device::DeviceSupervisor supervisor_;
    device::DeviceMailboxes mailboxes_;
    device::DeviceSnapshot snapshot_;
    std::uint64_t number_ = 0;
};

inline device::Description wheel_of(double torque, const Vec3& axis = Vec3(0, 0, -1)) {
    device::Description wheel;
    wheel.name = "a wheel";
    wheel.id = "wheel-1";
    wheel.sensing = device::Sensing::angle;
    wheel.axis = axis;
    wheel.renders = {false, false, false, true, true, true};
    wheel.limits.force = 0.0;
    wheel.limits.torque = torque;
    return wheel;
}

inline device::Description puck() {
    device::Description puck;
    puck.name = "a puck";
    puck.sensing = device::Sensing::velocity;
    puck.limits.force = puck.limits.torque = 0.0;
    puck.rate = 125.0;
    puck.buttons = 2;
    return puck;
}

}  // namespace bolt::test
