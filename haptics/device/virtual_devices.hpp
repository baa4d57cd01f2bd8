// Devices without hardware: mouse and keyboard as a puck, recorded samples, and, for tests, a scripted device
// with fault injection.
#pragma once

#include <cstddef>

#include "haptics/device/device.hpp"

namespace bolt::device {

// Deflection, −1 … 1, along and about the axes of the device frame.
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

// Mouse and keyboard as a puck: the window sets the deflection, the device reports it.
class VirtualPuck {
  public:
    VirtualPuck(const VirtualPuckOptions& options, Timer timer);
    VirtualPuck(VirtualPuck&&) noexcept;
    VirtualPuck& operator=(VirtualPuck&&) noexcept;
    ~VirtualPuck();

    // Call at least once a frame, from one thread. Never waits.
    void set_input(const PuckInput& input);

    // Devices that the factory opened may outlive the puck; they then report zero velocity.
    [[nodiscard]] DeviceFactory factory();

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

// Returns sample `index`, with increasing times; nullopt after the last.
using RecordedSamples = std::function<std::optional<Sample>(std::size_t index)>;

// A device that plays recorded samples at their recorded times; restarts at each opening. After the last
// sample the pose stays and all buttons are released. Rendered force has no effect. Opening fails if there is
// no sample.
DeviceFactory recorded(Description description, RecordedSamples recording, Timer timer);

enum class InjectedFault : std::uint8_t {
    unplugged,     // read and write fail, it cannot be opened, the motors have no power
    silent,        // sends nothing, but accepts writes and keeps its force
    stuck,         // read and write block until the interval ends
    slow,          // each write takes slow_write_time
    not_a_number,  // the pose contains NaN
    jumped,        // the pose is off by 0.5 m
};
inline constexpr std::size_t injected_fault_count = 6;
inline constexpr double slow_write_time = 0.015;  // s

struct FaultInterval {
    InjectedFault what = InjectedFault::silent;
    double from = 0.0, until = 0.0;  // s on the timer's clock
};

// The hand that holds a scripted device, for tests: a mass, pulled by a spring and damper to the intended
// pose and pushed by the device's force. The arm that a user can select has HandAndArmParameters instead
// (simulated_arm.hpp). Defaults: a relaxed grip, within the ranges of tests/support/random_arm.hpp.
struct HandImpedance {
    double mass = 0.3, stiffness = 300.0, damping = 10.0;          // kg, N/m, N·s/m
    double inertia = 2e-3, torsion = 2.0, angular_damping = 0.05;  // kg·m², N·m/rad, N·m·s/rad
};

struct ScriptedDeviceOptions {
    Description description;
    std::function<Sample(double time)> script;  // the intended motion
    std::optional<HandImpedance> hand;  // nullopt: the motion follows the script and ignores the force
    std::vector<FaultInterval> faults;
};

// A device for tests: a script gives the intended motion, an optional hand impedance yields to the rendered
// force, and faults of real devices can be injected. The arm that a user can select is SimulatedArm
// (simulated_arm.hpp). Works on any clock. Not thread-safe: call it and its connections from one thread. It
// must outlive the connections that its factory creates.
class ScriptedDevice {
  public:
    ScriptedDevice(ScriptedDeviceOptions design, Timer timer);

    [[nodiscard]] DeviceFactory factory();
    void inject(const FaultInterval& fault);

    // For observers: the force at the hand now, and the true pose of the hand.
    [[nodiscard]] force::OutputCommand rendered() const;
    [[nodiscard]] const Sample& hand() const { return now_; }
    [[nodiscard]] bool is_active(InjectedFault fault) const;

  private:
    class Connection;
    void advance();
    bool is_unplugged();
    void step(const Sample& intended, double dt);
    [[nodiscard]] const FaultInterval* find(InjectedFault what) const;

    ScriptedDeviceOptions options_;
    Timer timer_;
    force::OutputCommand command_;
    Sample now_;
    Vec3 velocity_{0.0}, angular_velocity_{0.0};
    double turn_rate_ = 0.0;
    double time_ = 0.0;  // s, time of now_
    bool begun_ = false;
};

}  // namespace bolt::device
