// An emulated device at the other end of a driver's line, in a time of its own: it goes on while the driver
// waits. No thread, no kernel.
#pragma once

#include <deque>
#include <memory>

#include "haptics/device/hid_line.hpp"
#include "tools/emulate/hid.hpp"

namespace bolt::emulate {

// What both ends share; outlives the line.
struct Plug {
    HidDevice* device = nullptr;
    double time = 0.0;       // s
    bool pulled = false;     // everything fails from now on
    double write_takes = 0;  // s of each report that is sent
};

class HidLine : public device::HidLine {
  public:
    explicit HidLine(Plug& plug) : plug_(plug) {}

    Result<std::span<const std::uint8_t>> read(double patience) override;
    Status write(std::span<const std::uint8_t> report) override;
    Status send_feature(std::span<const std::uint8_t> report) override;
    Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) override;

  private:
    Plug& plug_;
    std::deque<Bytes> waiting_;
    Bytes read_;
};

}  // namespace bolt::emulate
