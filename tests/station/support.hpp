// A whole station in virtual time: devices on lines that have clocks of their own, the servo's tick between
// them. What threads do beside each other is done in turn, so every run is the same.
#pragma once

#include <optional>

#include "haptics/device/simulated.hpp"
#include "haptics/station/step.hpp"
#include "tests/device/support.hpp"
#include "tests/servo/support.hpp"

namespace bolt::test {

// A device, its keeper and their mailboxes, as far as their thread would have come.
class VirtualLine {
  public:
    explicit VirtualLine(device::SimulatedDesign design)
        : thing(std::move(design), device::timer_of(time_)), keeper_(thing.open(), device::timer_of(time_)) {}

    device::Simulated thing;

    void until(double now) {
        while (time_.now < now) device::serve(keeper_, boxes_, told_);
    }
    const device::Told& told() {
        boxes_.told.update();
        return boxes_.told.latest();
    }
    void order(const force::OutputCommand& command) { boxes_.orders.write({command, true, ++number_}); }
    [[nodiscard]] const device::Report& report() const { return keeper_.report(); }
    [[nodiscard]] double now() const { return time_.now; }

  private:
    device::VirtualTime time_;

  public:
    device::Keeper& keeper() { return keeper_; }

  private:
    device::Keeper keeper_;
    device::Mailboxes boxes_;
    device::Told told_;
    std::uint64_t number_ = 0;
};

inline device::Description wheel_of(double torque, const Vec3& axis = Vec3(0, 0, -1)) {
    device::Description wheel;
    wheel.name = "a wheel";
    wheel.id = "wheel-1";
    wheel.sensing = device::Sensing::turn;
    wheel.axis = axis;
    wheel.renders = {false, false, false, true, true, true};
    wheel.limits.force = 0.0;
    wheel.limits.torque = torque;
    return wheel;
}

inline device::Description puck() {
    device::Description puck;
    puck.name = "a puck";
    puck.sensing = device::Sensing::rate;
    puck.limits.force = puck.limits.torque = 0.0;
    puck.rate = 125.0;
    puck.buttons = 2;
    return puck;
}

}  // namespace bolt::test
