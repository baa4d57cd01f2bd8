// An emulated SpaceMouse. It sends reports every 8 ms while it is deflected, once more when it is released,
// and at rest only when a button changes.
#pragma once

#include <array>

#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

struct EmulatedPuckOptions {
    // All axes in one report (256f:c62e), or translation and rotation in two (046d:c626).
    bool single_report = true;
    std::string serial{};
    HidFaults faults{};
};

class EmulatedPuck : public HidDevice {
  public:
    explicit EmulatedPuck(const EmulatedPuckOptions& options = {});

    // Deflection of each axis, −1 … 1, in 3Dconnexion's frame (x right, y towards the user, z down).
    std::array<double, 6> deflection{};
    std::uint32_t buttons = 0;
    bool stalled = false;  // sends nothing

    [[nodiscard]] const HidDescription& description() const override { return description_; }
    std::vector<Bytes> advance(double now) override;
    void output(std::span<const std::uint8_t>) override {}
    void set_feature(std::span<const std::uint8_t>) override {}
    Bytes get_feature(std::uint8_t) override { return {}; }

  private:
    HidDescription description_;
    bool single_report_;
    HidFaults faults_;
    Random random_;
    double next_ = 0.0;
    bool was_deflected_ = false;
    std::uint32_t last_buttons_ = 0;
};

}  // namespace bolt::emulate
