// An emulated device at the other end of a driver's line, in a time of its own: it goes on while the driver
// waits. No thread, no kernel.
#pragma once

#include <deque>
#include <memory>

#include "haptics/device/hid_transport.hpp"
#include "tools/emulate/hid.hpp"

namespace bolt::emulate {

// What both ends share; outlives the line.
struct EmulatedLink {
    HidDevice* device = nullptr;
    double time = 0.0;       // s
    bool pulled = false;     // everything fails from now on
    double write_takes = 0;  // s of each report that is sent
};

class EmulatedTransport : public device::HidTransport {
  public:
    explicit EmulatedTransport(EmulatedLink& plug) : plug_(plug) {}

    Result<std::span<const std::uint8_t>> read(double timeout) override;
    Status write(std::span<const std::uint8_t> report) override;
    Status send_feature(std::span<const std::uint8_t> report) override;
    Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) override;

  private:
    EmulatedLink& plug_;
    std::deque<Bytes> waiting_;
    Bytes read_;
};

}  // namespace bolt::emulate
