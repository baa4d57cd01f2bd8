// Helpers of the tests inside the virtual machine.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <string>

#include "haptics/device/connected_devices.hpp"
#include "haptics/device/hid_transport.hpp"
#include "tools/emulate/hid_device.hpp"

namespace bolt::test {

// Polls the condition. Returns true when it holds, false after `seconds`.
bool holds_within(const std::function<bool()>& condition, double seconds = 5.0);

// Plugs an emulated device into the kernel.
emulate::Uhid attach(std::unique_ptr<emulate::HidDevice> device);

// Waits until the kernel has created the node of the device with this id.
device::ListedDevice wait_for_device(const std::string& id);

// Runs the check as an unprivileged user; returns its result.
bool holds_unprivileged(const std::function<bool()>& check);

// Calls `action` with the emulated device as its own type.
template <class Device, class Action>
void with(const emulate::Uhid& plug, const Action& action) {
    plug.with([&](emulate::HidDevice& device) { action(dynamic_cast<Device&>(device)); });
}

}  // namespace bolt::test
