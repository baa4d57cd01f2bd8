// A thing that a hand holds: it says where the hand is, and pulls at it if it can. What a driver implements;
// what opens it again after it was unplugged, and keeps it away from the servo, is not its business.
//
// A device's own frame: x to the right, y up, z towards the user, origin in the middle of its reach. One
// thread calls a device, always the same one.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/pose.hpp"
#include "engine/base/result.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::device {

enum class Sensing : std::uint8_t {
    pose,  // where the hand is
    rate,  // how fast it wants to go: a puck that springs back
    turn,  // how far it has turned one axis, over many turns: a wheel, a wrench handle on a motor
};

struct Description {
    std::string name;  // in words, as the device calls itself
    std::string id;    // the same whenever this very thing is plugged in again
    Sensing sensing = Sensing::pose;
    std::array<bool, 6> renders{};  // force along x, y, z, torque about them; `limits` says how much
    force::OutputLimits limits;     // force 0, torque 0: it renders nothing
    double rate = 1000.0;           // samples a second while the hand moves
    bool rests = false;             // may say nothing while the hand is still, as every Sensing::rate may
    // m, either way from the middle; 0: it has no places, as a puck or a wheel
    Vec3 reach{0.0};
    Vec3 axis{0.0, 0.0, 1.0};  // unit, of Sensing::turn
    int buttons = 0;
    std::vector<std::string> remarks;  // what is wrong with it or unlike others, and how to mend it
};

struct Sample {
    Pose pose;                   // of the grip, device frame; Sensing::pose
    Vec3 velocity{0.0};          // m/s, Sensing::rate: what the hand asks for
    Vec3 angular_velocity{0.0};  // rad/s
    double turn = 0.0;           // rad, right-handed about the axis; Sensing::turn
    std::uint32_t buttons = 0;   // a bit each
    double time = 0.0;           // s of the caller's clock, when it was read
};

class Device {
  public:
    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    // Leaves the device without force, if it can still be told so.
    virtual ~Device() = default;

    [[nodiscard]] virtual const Description& describe() const = 0;

    // Waits until the device says something, at most `patience` s. None: it said nothing. An error: it is
    // gone, or not what it was; it is then closed and opened anew.
    virtual Result<std::optional<Sample>> read(double patience) = 0;

    // Device frame, N and N·m, within the limits that it described. It may take its time.
    virtual Status write(const force::OutputCommand& command) = 0;
};

// Opens a device, again and again if need be; the error says what a user can do about it.
using Open = std::function<Result<std::unique_ptr<Device>>()>;

}  // namespace bolt::device
