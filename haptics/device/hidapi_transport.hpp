// HidTransport for the kernel's hidraw nodes, through hidapi.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "haptics/device/hid_transport.hpp"

namespace bolt::device {

// Errors: not permitted (names the udev rule), disconnected.
Result<std::unique_ptr<HidTransport>> open_hid(const std::filesystem::path& node);

// Checks that the node can be opened for reading and writing, with the same errors.
Status can_open_hid(const std::filesystem::path& node);

// Reads the report descriptor from sysfs, because hidapi 0.13 does not return it.
Result<std::vector<std::uint8_t>> descriptor_of(const std::filesystem::path& node);

}  // namespace bolt::device
