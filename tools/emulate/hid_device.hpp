// Emulated HID devices: a builder of report descriptors, the interface of a device, a transport that connects
// a device to a driver in simulated time, and one that plugs it into the kernel.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/random.hpp"
#include "engine/base/result.hpp"
#include "haptics/device/hid_transport.hpp"

namespace bolt::emulate {

// Builds a report descriptor item by item (HID 1.11, section 6.2.2).
class DescriptorBuilder {
  public:
    // `head` is the item's prefix without the size bits. `bytes` is the size of the value; 0: the smallest
    // that fits.
    DescriptorBuilder& item(unsigned head, std::int64_t value, int bytes = 0) {
        const bool fits_one = value >= -128 && value <= 127, fits_two = value >= -32768 && value <= 32767;
        const int n = bytes != 0 ? bytes : fits_one ? 1 : fits_two ? 2 : 4;
        out.push_back(static_cast<std::uint8_t>(head | (n == 4 ? 3U : static_cast<unsigned>(n))));
        for (int i = 0; i < n; ++i)
            out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
        return *this;
    }
    DescriptorBuilder& page(int p) { return item(0x04, p, p > 255 ? 2 : 1); }
    DescriptorBuilder& usage(int u) { return item(0x08, u, u > 255 ? 2 : 1); }
    DescriptorBuilder& usages(int from, int to) { return item(0x18, from, 1).item(0x28, to, 1); }
    DescriptorBuilder& range(std::int64_t low, std::int64_t high) { return item(0x14, low).item(0x24, high); }
    DescriptorBuilder& fields(int count, int bits) { return item(0x94, count, 1).item(0x74, bits, 1); }
    DescriptorBuilder& id(int i) { return item(0x84, i, 1); }
    DescriptorBuilder& input(int flags) { return item(0x80, flags, 1); }
    DescriptorBuilder& output(int flags) { return item(0x90, flags, 1); }
    DescriptorBuilder& feature(int flags) { return item(0xb0, flags, 1); }
    DescriptorBuilder& begin(int type) { return item(0xa0, type, 1); }
    DescriptorBuilder& end() {
        out.push_back(0xc0);
        return *this;
    }
    std::vector<std::uint8_t> out;
};

using Bytes = std::vector<std::uint8_t>;

struct HidDescription {
    std::uint16_t vendor = 0, product = 0;
    std::string name, serial;
    Bytes descriptor;
};

// Probabilities of faults in each input report.
struct HidFaults {
    double truncated = 0.0;   // the report is too short
    double unknown_id = 0.0;  // its id is not declared in the descriptor
    double changed = 0.0;     // a byte after the id is changed
    std::uint64_t seed = 1;
};

// An emulated device without I/O of its own: reports and time in, reports out.
class HidDevice {
  public:
    HidDevice() = default;
    HidDevice(const HidDevice&) = delete;
    HidDevice& operator=(const HidDevice&) = delete;
    virtual ~HidDevice() = default;

    [[nodiscard]] virtual const HidDescription& description() const = 0;
    // Returns the input reports since the last call, each with its id first. `now` is the time in s; it must
    // not decrease.
    virtual std::vector<Bytes> advance(double now) = 0;
    virtual void output(std::span<const std::uint8_t> report) = 0;
    virtual void set_feature(std::span<const std::uint8_t> report) = 0;
    virtual Bytes get_feature(std::uint8_t report) = 0;  // with its id first; empty: refused
};

// Returns the reports with random faults.
std::vector<Bytes> with_faults(std::vector<Bytes> reports, const HidFaults& faults, Random& random);

// The state that a test and an EmulatedTransport share. It must outlive the transport.
struct EmulatedLink {
    HidDevice* device = nullptr;
    double time = 0.0;          // s
    bool unplugged = false;     // the device is unplugged: every call fails
    double write_duration = 0;  // s, duration of each write
};

// Connects a driver to an emulated device in simulated time, which advances while the driver waits. Uses no
// thread and no kernel.
class EmulatedTransport : public device::HidTransport {
  public:
    explicit EmulatedTransport(EmulatedLink& link) : link_(link) {}

    Result<std::span<const std::uint8_t>> read(double timeout) override;
    Status write(std::span<const std::uint8_t> report) override;
    Status send_feature(std::span<const std::uint8_t> report) override;
    Result<std::span<const std::uint8_t>> get_feature(std::span<std::uint8_t> report) override;

  private:
    EmulatedLink& link_;
    std::deque<Bytes> queue_;
    Bytes read_;
};

// An emulated HID device plugged into the kernel through /dev/uhid, so that it appears as /dev/hidraw*. Needs
// root and the module uhid.
class Uhid {
  public:
    // Starts a thread that advances the device every millisecond.
    static Result<Uhid> plug_in(std::unique_ptr<HidDevice> device);

    Uhid(Uhid&&) noexcept;
    Uhid& operator=(Uhid&&) noexcept;
    ~Uhid();  // unplugs the device

    // Calls `access` with the device while the thread does not use it.
    void with(const std::function<void(HidDevice&)>& access) const;

  private:
    struct Shared;
    explicit Uhid(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate
