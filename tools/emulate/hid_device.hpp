// Report descriptors written item by item: HID 1.11, section 6.2.2.
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

class Items {
  public:
    // `head` with the size bits left 0; as many bytes as the value needs, or as many as are asked for.
    Items& item(unsigned head, std::int64_t value, int bytes = 0) {
        const bool fits_one = value >= -128 && value <= 127, fits_two = value >= -32768 && value <= 32767;
        const int n = bytes != 0 ? bytes : fits_one ? 1 : fits_two ? 2 : 4;
        out.push_back(static_cast<std::uint8_t>(head | (n == 4 ? 3U : static_cast<unsigned>(n))));
        for (int i = 0; i < n; ++i)
            out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
        return *this;
    }
    Items& page(int p) { return item(0x04, p, p > 255 ? 2 : 1); }
    Items& usage(int u) { return item(0x08, u, u > 255 ? 2 : 1); }
    Items& usages(int from, int to) { return item(0x18, from, 1).item(0x28, to, 1); }
    Items& range(std::int64_t low, std::int64_t high) { return item(0x14, low).item(0x24, high); }
    Items& fields(int count, int bits) { return item(0x94, count, 1).item(0x74, bits, 1); }
    Items& id(int i) { return item(0x84, i, 1); }
    Items& input(int flags) { return item(0x80, flags, 1); }
    Items& output(int flags) { return item(0x90, flags, 1); }
    Items& feature(int flags) { return item(0xb0, flags, 1); }
    Items& begin(int type) { return item(0xa0, type, 1); }
    Items& end() {
        out.push_back(0xc0);
        return *this;
    }
    std::vector<std::uint8_t> out;
};

// HID devices that are not there. Pure: reports and time in, reports out; hid_line.hpp hands one to a driver,
// uhid.hpp to the kernel.

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

// An emulated device at the other end of a driver's line, in a time of its own: it goes on while the driver
// waits. No thread, no kernel.

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

// An emulated HID device plugged into the kernel through /dev/uhid: /dev/hidraw* and all. Needs root, and the
// module uhid.

class Uhid {
  public:
    // A thread plays the device from now on, every millisecond.
    static Result<Uhid> plug_in(std::unique_ptr<HidDevice> device);

    Uhid(Uhid&&) noexcept;
    Uhid& operator=(Uhid&&) noexcept;
    ~Uhid();  // unplugs it

    // Looks at the device, or does something to it, while it is not being played.
    void with(const std::function<void(HidDevice&)>& look) const;

  private:
    struct Shared;
    explicit Uhid(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate
