// Emulated arms, each held by the hand of its emulation and opened by our driver, in virtual time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::test {

// A fault of the arm while a lesson runs.
struct ArmFault {
    std::string name;
    std::function<void()> begin, end;
    bool lasts = true;  // until `end`; otherwise a moment
};

// In the device's frame. All functions share one emulation, so that only one arm of a vendor may exist.
struct HeldArm {
    std::string name;
    device::DeviceFactory open;
    device::Timer timer;
    std::function<void(const Pose&)> intend;  // the pose that the hand wants
    std::function<void(std::uint32_t buttons)> press;
    std::function<force::OutputCommand()> force;  // that acts on the hand now
    double stiffness = 300.0, damping = 12.0;     // N/m, N·s/m, of the hand
    bool braces = true;  // the hand compensates a steady force; otherwise the user corrects what he sees
    std::vector<ArmFault> faults;
};

// In real time the arm is that of the program that loads the library; `open`, `timer` and
// `faults` are then empty.
enum class ArmClock : std::uint8_t { virtual_time, real_time };

// `active`: with motors in its wrist.
std::unique_ptr<HeldArm> force_dimension_arm(bool active, ArmClock clock = ArmClock::virtual_time);
std::unique_ptr<HeldArm> open_haptics_arm(ArmClock clock = ArmClock::virtual_time);
// By the messages of Haply's service, without its sockets and threads: these run in real time
// (tests/device/haply.cpp).
std::unique_ptr<HeldArm> haply_arm();
// That of `train --device simulated-arm`, in virtual time.
std::unique_ptr<HeldArm> simulated_arm();

}  // namespace bolt::test
