// How the emulated wheels describe their reports.
#pragma once

#include "tools/emulate/hid_device.hpp"

namespace bolt::emulate {

// As OpenFFBoard's firmware numbers them; of its effects only constant force.
Bytes board_descriptor();

// Another wheel's: other numbers, an axis without a sign, controls as a list, one effect in a fixed place,
// no start delay.
Bytes other_wheel_descriptor();

// A wheel on a motor, as an OpenFFBoard shows itself or as others with USB's force feedback do, and a hand at
// it. It does what its reports say by fixed places in them, as a firmware does.
//
// Reports of an OpenFFBoard: ffb_defs.h and usb_hid_ffb_desc.h of its firmware.

struct WheelOptions {
    bool board = true;  // an OpenFFBoard. Else: another's numbers, no start delay, controls as a list, no
                        // places of effects, an axis without a sign
    std::string serial{};
    double full_torque = 10.0;  // N·m of the motor
    double power = 0.5;         // share of it that the board lets through
    double degrees = 1080.0;    // from stop to stop
    double counts_per_turn = 4000.0;
    double inertia = 0.02;      // kg·m², hand included
    double damping = 0.5;       // N·m·s/rad
    double effect_life = 60.0;  // s after which a force dies that was not started again
    // N·m/rad to the middle, until all effects are stopped; a reset brings it back.
    double own_spring = 0.0;
    HidFaults faults{};
};

class Wheel : public HidDevice {
  public:
    explicit Wheel(const WheelOptions& design = {});

    // The hand: a spring to an angle. rad, to the right; N·m/rad.
    double hand = 0.0, hand_stiffness = 0.0;
    std::uint32_t buttons = 0;
    bool stalled = false;  // neither sends nor hears

    [[nodiscard]] double angle() const { return angle_; }  // rad, to the right
    [[nodiscard]] double torque() const;                   // N·m of the motor, to the right
    [[nodiscard]] bool has_effect() const { return loaded_; }
    [[nodiscard]] std::uint64_t reports_received() const { return heard_; }  // reports

    [[nodiscard]] const HidDescription& design() const override { return shown_; }
    std::vector<Bytes> advance(double now) override;
    void output(std::span<const std::uint8_t> report) override;
    void set_feature(std::span<const std::uint8_t> report) override;
    Bytes get_feature(std::uint8_t report) override;

  private:
    void control(std::uint8_t what);
    void answer(std::span<const std::uint8_t> question);
    [[nodiscard]] Bytes axis_report() const;

    WheelOptions design_;
    HidDescription shown_;
    Random random_;
    double angle_ = 0.0, speed_ = 0.0, time_ = 0.0, next_ = 0.0, told_at_ = -1.0, started_ = 0.0;
    bool springs_ = true, enabled_ = false, loaded_ = false, set_ = false, playing_ = false;
    double gain_ = 1.0, effect_gain_ = 0.0, magnitude_ = 0.0;  // shares
    double duration_ = 0.0;                                    // s
    std::uint64_t heard_ = 0;
    Bytes told_;
    std::vector<Bytes> answers_;
};

}  // namespace bolt::emulate
