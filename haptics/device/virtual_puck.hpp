// Mouse and keyboard as a puck: the window sets the deflection, the device reports it.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

// Deflection, −1 … 1 of full speed along and about the axes of the device frame.
struct PuckInput {
    Vec3 along{0.0};
    Vec3 about{0.0};
    std::uint32_t buttons = 0;
};

// The response is quadratic (half deflection gives a quarter of the speed), so one setting serves both
// reaching and placing the jaw. Values chosen by trial.
struct VirtualPuckOptions {
    double speed = 0.4;           // m/s at full deflection
    double angular_speed = 2.0;   // rad/s
    double rate = 125.0;          // 1/s
    double input_timeout = 0.25;  // s without set_input() until the deflection is zero (a window may hang)
};

class VirtualPuck {
  public:
    VirtualPuck(const VirtualPuckOptions& options, Timer timer);
    VirtualPuck(VirtualPuck&&) noexcept;
    VirtualPuck& operator=(VirtualPuck&&) noexcept;
    ~VirtualPuck();

    // Call at least once a frame, from one thread. Never waits.
    void set_input(const PuckInput& push);

    // The device may outlive the puck; it then reports rest.
    [[nodiscard]] DeviceFactory open();

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

}  // namespace bolt::device
