// A force-feedback arm and the hand that holds it, simulated as a mass on a spring: for tests, and as a
// device for users without hardware, whose mouse moves the hand.
//
// The hand is a mass, a damper and a spring to its intended pose, the model of Hogan (Controlling impedance
// at the man/machine interface, ICRA 1989). The arm adds mass, dry friction, the steps of its encoders and a
// delay.
#pragma once

#include <array>
#include <optional>

#include "haptics/device/device.hpp"

namespace bolt::device {

// Parameters of the arm and of the hand that holds it, combined into one system.
struct HandAndArmParameters {
    double mass = 0.3;               // kg, hand and device
    double damping = 5.0;            // N·s/m
    double stiffness = 300.0;        // N/m
    double inertia = 2e-3;           // kg·m²
    double angular_damping = 0.03;   // N·m·s/rad
    double angular_stiffness = 2.0;  // N·m/rad
    double friction = 0.05;          // N, of the device
    double angular_friction = 1e-3;  // N·m
    double encoder = 10e-6;          // m, one step
    double angular_encoder = 1e-4;   // rad
    int delay = 1;                   // ticks from sending to effect, at most 3
};

struct ArmModel {
    HandAndArmParameters parameters;
    Pose pose;                   // of the handle, device frame
    Pose intention;              // pose to which the hand's spring pulls
    Vec3 velocity{0.0};          // m/s
    Vec3 angular_velocity{0.0};  // rad/s
    // m/s and rad/s of the intention. The hand's damper acts on the difference, so that an arm whose
    // intention moves steadily does not lag behind it.
    Vec3 intention_velocity{0.0}, intention_angular_velocity{0.0};
    double energy_to_hand = 0.0;                 // J: force times motion, integrated every 25 µs
    std::array<force::OutputCommand, 4> sent{};  // the latest commands, newest first
};

// The pose that the encoders measure.
Pose encoder_pose(const ArmModel& arm);
// Moves arm and hand for `dt` s, a multiple of 25 µs. The command is sent at the beginning of the step.
void step(ArmModel& arm, const force::OutputCommand& command, double dt);

// The motion of the hand that holds a simulated arm. `moved` and `turned` are totals since the beginning, so
// that no motion is lost if the device reads only the latest value.
struct HandMotion {
    Vec3 moved{0.0};                  // m, along the axes of the device frame
    Quat turned{1.0, 0.0, 0.0, 0.0};  // unit, in the device frame
    // m and rad that the intention may be ahead of the arm: this limits how hard the hand pushes
    // against a wall.
    double max_deflection = 0.06, max_angular_deflection = 0.6;
    // 1/s, rate at which the intended position moves to the arm's position, as a relaxed hand lets the arm
    // move it. 0: firm.
    double compliance_rate = 0.0;
    std::uint32_t buttons = 0;
    // The pose of the hand in the device frame, if it is measured; it replaces `moved` and `turned`. The
    // greatest deflection still limits how hard the hand pushes, but the arm returns to this pose as soon as
    // it can. When a hand begins to be measured, the arm jumps to its pose.
    std::optional<Pose> target;
    double gripper = 1.0;  // 0 closed … 1 fully open
};

// The arm that a hand moves in the trainer. A mouse moves in steps of a frame; the intention follows it
// smoothly.
class SimulatedArm {
  public:
    // `parameters` should damp the hand well, because the user cannot see and stop a vibration of the hand.
    SimulatedArm(const Description& description, const HandAndArmParameters& parameters, Timer timer);
    SimulatedArm(SimulatedArm&&) noexcept;
    SimulatedArm& operator=(SimulatedArm&&) noexcept;
    ~SimulatedArm();

    // Call once a frame, from one thread. Never waits. After 0.25 s without a call the buttons are released
    // and the gripper is open.
    void set_motion(const HandMotion& motion);

    // Devices that the factory opened may outlive the arm; their buttons are then released.
    [[nodiscard]] DeviceFactory factory();

  private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
};

// The arm of `train --device simulated-arm`: 12 N, as an omega.7; no torque; an unlimited workspace. The
// stiffness is lower than an omega.7's, because the hand is a spring of 300 N/m.
Description simulated_arm_description();
HandAndArmParameters simulated_arm_parameters();

// The simulated arm that a tracked hand moves. Contacts and seated nuts hold this arm back, and with it the
// drawn hand. Closing the hand closes the arm's gripper.
Description tracked_hand_description();

}  // namespace bolt::device
