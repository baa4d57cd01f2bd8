// The transport of HID reports: its interface, and its implementation for the kernel's hidraw nodes through
// hidapi. tools/emulate implements the interface for emulated devices.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "engine/base/result.hpp"
#include "engine/base/steady_seconds.hpp"

namespace bolt::device {

// Reads and writes the reports of one HID device.
class HidTransport {
  public:
    HidTransport() = default;
    HidTransport(const HidTransport&) = delete;
    HidTransport& operator=(const HidTransport&) = delete;
    virtual ~HidTransport() = default;

    // Waits at most `timeout` s for an input report; empty on timeout. Numbered reports begin with their id.
    // The span is valid until the next call. Error::lost: the device is disconnected.
    virtual Result<std::span<const std::uint8_t>> read(double timeout) = 0;

    // Sends an output or a feature report. The first byte is its id, 0 if reports are not numbered.
    virtual Status write(std::span<const std::uint8_t> report) = 0;
    virtual Status send_feature(std::span<const std::uint8_t> report) = 0;

    // `report` begins with the id and has the full size; returns the received part, with the id.
    virtual Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) = 0;
};

// A monotonic clock in s, for time stamps and timeouts.
using SecondsClock = std::function<double()>;

// hidapi has one global error string and frees it in every call without an open device. Hold this lock during
// such calls; two threads that enumerate at once crash without it.
std::mutex& hidapi_lock();

// Opens a hidraw node. Fails if access is not permitted (the error names the udev rule) or the device is
// disconnected.
Result<std::unique_ptr<HidTransport>> open_hid(const std::filesystem::path& node);

// Checks that the node can be opened for reading and writing. Fails as open_hid().
Status can_open_hid(const std::filesystem::path& node);

// Reads the report descriptor from sysfs, because hidapi 0.13 does not return it.
Result<std::vector<std::uint8_t>> descriptor_of(const std::filesystem::path& node);

}  // namespace bolt::device
