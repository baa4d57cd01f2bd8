// An emulated force-feedback wheel with a motor and a hand: an OpenFFBoard, or a generic wheel of USB's PID
// class. It parses reports at fixed offsets, as firmware does. The OpenFFBoard's reports are those of
// ffb_defs.h and usb_hid_ffb_desc.h of its firmware.
#pragma once

#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

// Returns the report descriptor of OpenFFBoard's firmware. Constant force is the only effect.
Bytes board_descriptor();

// Returns the report descriptor of the generic wheel: other report ids, an unsigned axis, device control as
// an array, one effect block at a fixed index, no start delay.
Bytes generic_wheel_descriptor();

struct EmulatedWheelOptions {
    bool board = true;  // an OpenFFBoard, else the generic wheel
    std::string serial{};
    double full_torque = 10.0;  // N·m, of the motor
    double power = 0.5;         // fraction of it that the board permits
    double degrees = 1080.0;    // from stop to stop
    double counts_per_turn = 4000.0;
    double inertia = 0.02;      // kg·m², hand included
    double damping = 0.5;       // N·m·s/rad
    double effect_life = 60.0;  // s, after which an effect stops unless it is started again
    // N·m/rad, the device's own centring spring. It acts until all effects are stopped, and again after a
    // reset.
    double centring_spring = 0.0;
    HidFaults faults{};
};

class EmulatedWheel : public HidDevice {
  public:
    explicit EmulatedWheel(const EmulatedWheelOptions& options = {});

    // The hand is a spring to the angle `hand` (rad, positive to the right) with a stiffness in N·m/rad.
    double hand = 0.0, hand_stiffness = 0.0;
    std::uint32_t buttons = 0;
    bool stalled = false;  // neither sends nor receives

    [[nodiscard]] double angle() const { return angle_; }  // rad, positive to the right
    [[nodiscard]] double torque() const;                   // N·m, of the motor, positive to the right
    [[nodiscard]] bool has_effect() const { return loaded_; }
    [[nodiscard]] std::uint64_t reports_received() const { return reports_received_; }

    [[nodiscard]] const HidDescription& description() const override { return description_; }
    std::vector<Bytes> advance(double now) override;
    void output(std::span<const std::uint8_t> report) override;
    void set_feature(std::span<const std::uint8_t> report) override;
    Bytes get_feature(std::uint8_t report) override;

  private:
    void control(std::uint8_t bits);
    void answer_request(std::span<const std::uint8_t> request);
    [[nodiscard]] Bytes axis_report() const;

    EmulatedWheelOptions options_;
    HidDescription description_;
    Random random_;
    double angle_ = 0.0, speed_ = 0.0, time_ = 0.0, next_ = 0.0, last_report_time_ = -1.0, started_ = 0.0;
    bool springs_ = true, enabled_ = false, loaded_ = false, set_ = false, playing_ = false;
    double gain_ = 1.0, effect_gain_ = 0.0, magnitude_ = 0.0;  // fractions
    double duration_ = 0.0;                                    // s
    std::uint64_t reports_received_ = 0;
    Bytes last_report_;
    std::vector<Bytes> answers_;
};

}  // namespace bolt::emulate
