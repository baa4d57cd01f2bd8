// Mouse and keyboard as a puck: what somebody pushes with them, as plain numbers, and a device that says so.
#pragma once

#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

// Shares of the fastest, −1 … 1 each, along and about the axes of device.hpp.
struct Push {
    Vec3 along{0.0};
    Vec3 about{0.0};
    std::uint32_t buttons = 0;
};

// Chosen: half a push goes a quarter as fast, so that both reaching and fitting a jaw are done at one
// setting.
struct PushFeel {
    double speed = 0.4;          // m/s at a whole push
    double angular_speed = 2.0;  // rad/s
    double rate = 125.0;         // 1/s
    double forgets = 0.25;       // s: a window that hangs must not go on pushing
};

class Puck {
  public:
    Puck(const PushFeel& feel, Timer timer);
    Puck(Puck&&) noexcept;
    Puck& operator=(Puck&&) noexcept;
    ~Puck();

    // From one thread, with every picture at least; never waits.
    void put(const Push& push);

    // Outlives the puck, and then rests.
    [[nodiscard]] Open open();

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

}  // namespace bolt::device
