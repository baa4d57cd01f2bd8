// A SpaceMouse without a hand at it. It sends every 8 ms while it is pushed, once more when it is let go, and
// nothing while it rests.
#pragma once

#include <array>

#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

struct PuckOptions {
    bool in_one = true;  // all axes in one report (256f:c62e), or pushes and turns in two (046d:c626)
    std::string serial{};
    HidFaults faults{};
};

class Puck : public HidDevice {
  public:
    explicit Puck(const PuckOptions& design = {});

    // What the hand does: −1 … 1 each, in 3Dconnexion's frame (x right, y towards the user, z down).
    std::array<double, 6> share{};
    std::uint32_t buttons = 0;
    bool stalled = false;  // sends nothing

    [[nodiscard]] const HidDescription& design() const override { return design_; }
    std::vector<Bytes> advance(double now) override;
    void output(std::span<const std::uint8_t>) override {}
    void set_feature(std::span<const std::uint8_t>) override {}
    Bytes get_feature(std::uint8_t) override { return {}; }

  private:
    HidDescription design_;
    bool in_one_;
    HidFaults faults_;
    Random random_;
    double next_ = 0.0;
    bool pushed_ = false;
    std::uint32_t told_buttons_ = 0;
};

}  // namespace bolt::emulate
