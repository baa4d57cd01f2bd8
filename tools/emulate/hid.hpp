// HID devices that are not there. Pure: reports and time in, reports out; hid_line.hpp hands one to a driver,
// uhid.hpp to the kernel.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/random.hpp"

namespace bolt::emulate {

using Bytes = std::vector<std::uint8_t>;

struct HidDescription {
    std::uint16_t vendor = 0, product = 0;
    std::string name, serial;
    Bytes descriptor;
};

// Shares of the input reports that something happens to.
struct HidFaults {
    double cut = 0.0;      // ends too early
    double strange = 0.0;  // has an id that nobody declared
    double changed = 0.0;  // has a byte changed behind its id
    std::uint64_t seed = 1;
};

class HidDevice {
  public:
    HidDevice() = default;
    HidDevice(const HidDevice&) = delete;
    HidDevice& operator=(const HidDevice&) = delete;
    virtual ~HidDevice() = default;

    [[nodiscard]] virtual const HidDescription& design() const = 0;
    // Input reports since the last call, their ids in front. The time now, s; it only goes on.
    virtual std::vector<Bytes> advance(double now) = 0;
    virtual void output(std::span<const std::uint8_t> report) = 0;
    virtual void set_feature(std::span<const std::uint8_t> report) = 0;
    virtual Bytes get_feature(std::uint8_t report) = 0;  // with its id in front; empty: refused
};

// What becomes of reports on the way.
std::vector<Bytes> with_faults(std::vector<Bytes> reports, const HidFaults& faults, Random& random);

}  // namespace bolt::emulate
