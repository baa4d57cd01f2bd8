// Reports to and from one HID device; what drivers speak through. hid_node.hpp is the kernel's, tests have
// devices that are not there.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "engine/base/result.hpp"

namespace bolt::device {

class HidLine {
  public:
    HidLine() = default;
    HidLine(const HidLine&) = delete;
    HidLine& operator=(const HidLine&) = delete;
    virtual ~HidLine() = default;

    // The next input report, with its id in front where reports are numbered; valid until the next call.
    // Waits at most `patience` s. Empty: nothing came. An error with `lost`: the device is gone.
    virtual Result<std::span<const std::uint8_t>> read(double patience) = 0;

    // An output or a feature report, the first byte its id, 0 where reports are not numbered.
    virtual Status write(std::span<const std::uint8_t> report) = 0;
    virtual Status send_feature(std::span<const std::uint8_t> report) = 0;

    // `report` holds the id in front and has the size of the whole; what came, with the id in front.
    virtual Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) = 0;
};

// s of a clock that only goes on. What stamps samples, and what a driver measures silence by.
using Clock = std::function<double()>;

double steady_seconds();

}  // namespace bolt::device
