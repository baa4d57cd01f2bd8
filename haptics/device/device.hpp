// The interface of a device driver, the description and samples of a device, its configuration, and the timer
// of device threads.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/device/preparation.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::device {

// A clock and a wait function for device threads: the machine's steady clock, or virtual time that advances
// only by waiting, so that tests are fast and repeatable.
struct Timer {
    std::function<double()> now;  // s, monotonic
    std::function<void(double seconds)> wait;
};

Timer steady_timer();

struct VirtualTime {
    double now = 0.0;  // s
};

Timer virtual_timer(VirtualTime& time);  // `time` must outlive the timer

// Device frame: x to the right, y up, z towards the user, origin in the middle of the reach.

enum class Sensing : std::uint8_t {
    pose,      // the pose of the hand
    velocity,  // a commanded velocity: a puck that springs back
    angle,     // the angle of one axis over many turns: a wheel, a wrench handle on a motor
};

struct Description {
    std::string name;           // as the device reports it
    std::string id;             // the same each time this unit is plugged in
    std::string model, serial;  // as the device reports them; empty: it does not
    Sensing sensing = Sensing::pose;
    bool senses_rotation = true;    // of the hand; with Sensing::pose
    std::array<bool, 6> renders{};  // force along x, y, z, torque about them; magnitudes in `limits`
    force::OutputLimits limits;     // force 0 and torque 0: input only
    double rate = 1000.0;           // samples per second while the hand moves
    bool silent_at_rest = false;    // may send nothing while the hand rests; implied by Sensing::velocity
    // m, half the workspace along each axis; 0: it has no limit, or the device senses no position
    Vec3 half_workspace{0.0};
    Vec3 axis{0.0, 0.0, 1.0};  // unit, of Sensing::angle
    int buttons = 0;
    bool senses_gripper = false;       // jaws for thumb and finger; with Sensing::pose
    std::vector<std::string> remarks;  // restrictions and peculiarities, each with a remedy
};

// Calibration and heat of an open device, as far as the device reports them.
struct DeviceHealth {
    // The device has calibrated its position; none: no calibration is needed or reported.
    std::optional<bool> calibrated;
    // 0 … 1, of the hottest motor: at 1 the device ends its force. None: not reported.
    std::optional<double> heat;
    bool cooling = false;  // the device renders no force until its motors are cool
};
inline constexpr double warm_threshold = 0.8;  // heat from which the user should rest the arm
[[nodiscard]] inline bool is_warm(const DeviceHealth& c) {
    return c.cooling || c.heat.value_or(0.0) >= warm_threshold;
}

struct Sample {
    Pose pose;                   // of the handle, device frame; with Sensing::pose
    Vec3 velocity{0.0};          // m/s; with Sensing::velocity
    Vec3 angular_velocity{0.0};  // rad/s
    double angle = 0.0;          // rad, right-handed about the axis; with Sensing::angle
    std::uint32_t buttons = 0;   // bit i: button i, from 0, is pressed
    double gripper = 1.0;        // 0 closed … 1 fully open; with Description::senses_gripper
    double time = 0.0;           // s, when it was read, on the caller's clock
};

// The error of a device that is disconnected or has ended its force: the supervisor reopens the device.
Error lost_device_error(std::string what, std::string expected);

// The error of an arm that is connected and cannot be opened before `preparation` is done.
Error unprepared_device_error(std::string what, std::string expected, Preparation preparation);
// The same for an arm that must move by itself to find its position and has no permission to move.
Error move_permission_error(const std::string& name, std::string_view id);

// The interface of a driver: a device that measures the hand and may render force. A driver neither reopens a
// lost device (DeviceSupervisor does) nor exchanges data with the servo (DeviceThread does). All calls come
// from one thread.
class DeviceDriver {
  public:
    DeviceDriver() = default;
    DeviceDriver(const DeviceDriver&) = delete;
    DeviceDriver& operator=(const DeviceDriver&) = delete;
    // Releases the force if the device is still connected.
    virtual ~DeviceDriver() = default;

    [[nodiscard]] virtual const Description& description() const = 0;
    // As of the latest read(). Does not block.
    [[nodiscard]] virtual DeviceHealth health() const { return {}; }

    // Waits at most `timeout` s for a sample; nullopt on timeout. An error means that the device is lost; the
    // caller then closes it and opens it again.
    virtual Result<std::optional<Sample>> read(double timeout) = 0;

    // Renders a force (N) and torque (N·m) in the device frame, within description().limits. May block.
    virtual Status write(const force::OutputCommand& command) = 0;
};

// Clamps a finite command to the limits of the device and to the axes that it renders.
force::OutputCommand clamp_to_limits(const Description& description, force::OutputCommand command);

// Opens the device; called again after each loss. The error states a remedy for the user.
using DeviceFactory = std::function<Result<std::unique_ptr<DeviceDriver>>()>;

// Properties that a wheel does not report: the installer enters them.
struct WheelConfig {
    // Motor torque at full drive, N·m. Overestimating it weakens the rendered torque, which is the safe side;
    // the default is that of the strongest wheels on the market.
    double full_torque = 25.0;
    double max_torque = 2.0;  // N·m, limit of the rendered torque

    // Encoder counts per turn, for boards that report counts. 0: unknown; `range` then gives the angle.
    double counts_per_turn = 0.0;
    // rad from stop to stop, for wheels that do not report their range.
    double range = to_radians(900.0);

    bool reversed = false;      // the motor turns against the commanded direction
    Vec3 axis{0.0, 0.0, -1.0};  // unit, device frame: clockwise as the user sees it is positive
    bool operator==(const WheelConfig&) const = default;
};

// Maps the deflection of a puck to velocity. Quadratic, for fine control at low speed.
struct PuckResponse {
    double speed = 0.25;          // m/s at full deflection
    double angular_speed = 1.5;   // rad/s at full deflection
    double dead_zone = 0.04;      // deflection that counts as zero: pucks do not centre exactly
    double report_timeout = 0.1;  // s without a report while deflected until the velocity becomes zero
};

// Describes a device in plain text for `boltwright devices`: one line each for model and serial number, what
// it senses, what it renders, and its remarks.
std::vector<std::string> summary_lines(const Description& description);
// Describes calibration and motor heat, as far as the device reports them.
std::vector<std::string> summary_lines(const DeviceHealth& health);

}  // namespace bolt::device
