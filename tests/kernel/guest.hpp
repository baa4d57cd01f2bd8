// What the tests inside the software machine have in common.
#pragma once

#include <doctest/doctest.h>

#include <functional>
#include <memory>
#include <string>

#include "haptics/device/hid_line.hpp"
#include "haptics/device/list.hpp"
#include "tools/emulate/uhid.hpp"

namespace bolt::test {

// Waits, at most so many seconds, until it is so.
bool becomes(const std::function<bool()>& so, double seconds = 5.0);

emulate::Uhid plugged(std::unique_ptr<emulate::HidDevice> device);

// The device of that id, when the kernel has made its node.
device::Listed listed(const std::string& id);

// What a check finds when nobody in particular runs it.
bool holds_for_nobody(const std::function<bool()>& check);

// What an emulated device is or does.
template <class Device, class Look>
void with(const emulate::Uhid& plug, const Look& look) {
    plug.with([&](emulate::HidDevice& device) { look(dynamic_cast<Device&>(device)); });
}

}  // namespace bolt::test
