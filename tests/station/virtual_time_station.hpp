// A lesson's station in virtual time, which a test advances. Mouse and keyboard move the tool.
#pragma once

#include "game/session/lesson_session.hpp"
#include "game/station/stepped_station.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/device_thread.hpp"

namespace bolt::test {

class VirtualTimeStation final : public station_setup::SteppedStation {
  public:
    // `scale`: that of the workspace map.
    VirtualTimeStation(session::SessionSetup prepared, session::LessonOptions options, double scale = 1.0)
        : puck_({}, device::virtual_timer(time_)),
          supervisor_(puck_.factory(), device::virtual_timer(time_)) {
        while (!supervisor_.status().description) serve();
        layout_.mover = *supervisor_.status().description;
        layout_.mover_buttons = {1, 0, 0, 0};
        layout_.workspace.scale = scale;
        options.device_limits = station::limits_of(layout_);
        session::set_device_limits(options, prepared);
        setup_ = prepared.setup;
        servo_ = std::move(prepared.state);
        state_ = station::initial_state(layout_);
        controls_.pause = true;
    }

    // Adds a gloved hand, with its wrist at `wrist` in the frame of the tool.
    void wear(const station::DisplayedHand& hand, const Pose& wrist) {
        hand_ = hand;
        layout_.wrist = wrist;
        state_ = station::initial_state(layout_);
    }

    // Gives the device a gripper, open.
    void add_gripper() {
        layout_.mover->senses_gripper = true;
        gripper_ = 1.0;
    }

    // Makes the device one that senses its pose, without forces, and holds it there.
    void hold(const station::MoverSample& held) {
        if (!held_) {
            layout_.mover->sensing = device::Sensing::pose;
            state_ = station::initial_state(layout_);
        }
        held_ = held;
    }

    // Advances the time by `seconds`. The frames of a lesson do not advance it, because step() does nothing.
    void advance(double seconds) {
        if (!stopped_) run_ticks(seconds);
    }

    void set_puck_input(const device::PuckInput& input) override { puck_.set_input(input); }
    [[nodiscard]] std::uint64_t lost_ticks() const override { return lost_; }
    const station::DisplayedHand* hand() override { return hand_ ? &*hand_ : nullptr; }
    std::vector<std::string> fault_messages() override { return fault_messages_; }
    device::DeviceHealth health() override { return health_; }
    device::ArmNeeds needs() override { return needs_; }
    void permit_move() override { ++permissions_; }
    const servo::Timing* stop() override {
        stopped_ = true;
        return nullptr;
    }

    // State of the station and its faults, set by tests.
    std::vector<std::string> fault_messages_;
    device::ArmNeeds needs_;
    device::DeviceHealth health_;
    int permissions_ = 0;  // that the user has given
    std::uint64_t lost_ = 0;
    std::optional<station::DisplayedHand> hand_;  // of a gloved hand
    double gripper_ = 1.0;                        // 0 closed … 1 open
    bool unplugged_ = false;
    bool corrupts_next_record_ = false;  // the record of the next tick deviates from the tick itself

  private:
    void serve() { device::run_once(supervisor_, mailboxes_, snapshot_); }
    void read_devices(double now, station::StationInputs& inputs) override {
        while (time_.now < now) serve();
        mailboxes_.snapshots.update();
        inputs.mover = mailboxes_.snapshots.latest();
        inputs.mover.usable = inputs.mover.usable && !unplugged_;
        inputs.mover.sample.gripper = gripper_;
        if (held_) {
            inputs.mover.usable = !unplugged_;
            inputs.mover.number = ++held_number_;
            inputs.mover.sample.pose = held_->pose;
            inputs.mover.sample.buttons = held_->buttons;
        }
        if (hand_) inputs.hand_grip = hand_->held ? servo::Grip::wrench : servo::Grip::none;
    }
    void write_devices(station::StationStep& done) override {
        mailboxes_.commands.write({done.commands.mover, true, ++command_number_});
        if (std::exchange(corrupts_next_record_, false)) done.tick.input.commanded_tool.position[0] += 1e-3F;
    }

    device::VirtualTime time_;
    device::VirtualPuck puck_;
    device::DeviceSupervisor supervisor_;
    device::DeviceMailboxes mailboxes_;
    device::DeviceSnapshot snapshot_;
    std::optional<station::MoverSample> held_;
    std::uint64_t held_number_ = 0, command_number_ = 0;
    bool stopped_ = false;
};

}  // namespace bolt::test
