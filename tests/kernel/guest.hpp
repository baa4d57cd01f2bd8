// Helpers of the tests inside the virtual machine.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <string>

#include "haptics/device/hid_devices.hpp"
#include "haptics/device/hid_transport.hpp"
#include "tools/emulate/hid_device.hpp"

namespace bolt::test {

// Polls until the condition holds; times out after this many seconds.
bool becomes(const std::function<bool()>& so, double seconds = 5.0);

emulate::Uhid plugged(std::unique_ptr<emulate::HidDevice> device);

// The device of that id, when the kernel has made its node.
device::ListedDevice listed(const std::string& id);

// Runs the check as an unprivileged user; returns its result.
bool holds_for_nobody(const std::function<bool()>& check);

// Calls `look` with the emulated device, as its type.
template <class Device, class Look>
void with(const emulate::Uhid& plug, const Look& look) {
    plug.with([&](emulate::HidDevice& device) { look(dynamic_cast<Device&>(device)); });
}

}  // namespace bolt::test
