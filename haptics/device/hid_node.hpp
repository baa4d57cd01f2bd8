// A HID device of the kernel's, through hidapi.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "haptics/device/hid_line.hpp"

namespace bolt::device {

// Errors say what to do: not permitted (the udev rule), not there any more.
Result<std::unique_ptr<HidLine>> open_hid(const std::filesystem::path& node);

// Whether it could be opened for reading and writing; the same errors.
Status can_open_hid(const std::filesystem::path& node);

// hidapi 0.13 does not give a device's report descriptor; the kernel does, to everybody.
Result<std::vector<std::uint8_t>> descriptor_of(const std::filesystem::path& node);

}  // namespace bolt::device
