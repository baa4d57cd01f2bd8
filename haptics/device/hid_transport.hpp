// Reads and writes the reports of one HID device. hidapi_transport.hpp implements it for the kernel,
// tools/emulate for emulated devices.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/base/result.hpp"

namespace bolt::device {

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
using Clock = std::function<double()>;

double steady_seconds();

}  // namespace bolt::device
