#include "game/station/lesson_station.hpp"

#include <limits>

#include "game/station/stepped_station.hpp"

namespace bolt::station_setup {

namespace {

class ThreadedStation final : public LessonStation {
  public:
    ThreadedStation(station::Station station, VirtualMover mover,
                    std::shared_ptr<device::MovePermission> permission)
        : mover_(std::move(mover)), permission_(std::move(permission)), station_(std::move(station)) {}

    void set_controls(const station::StationControls& controls) override { station_.set_controls(controls); }
    Status send(const station::StationCommand& command) override { return station_.send(command); }
    void set_puck_input(const device::PuckInput& input) override {
        if (auto* puck = std::get_if<device::VirtualPuck>(&mover_)) puck->set_input(input);
    }
    void set_hand_motion(const device::HandMotion& motion) override {
        if (auto* arm = std::get_if<device::SimulatedArm>(&mover_)) arm->set_motion(motion);
    }
    bool next_tick(station::StationTick& tick) override { return station_.next_tick(tick); }
    const station::StationTick& latest_tick() override { return station_.latest_tick(); }
    [[nodiscard]] std::uint64_t lost_ticks() const override { return station_.lost_ticks(); }
    const station::DisplayedHand* hand() override { return station_.hand(); }
    std::vector<std::string> fault_messages() override { return station_.fault_messages(); }
    device::ArmNeeds needs() override {
        const device::DeviceStatus* status = station_.mover_status();
        if (status == nullptr) return {};
        return {status->preparation, permission_ && permission_->active()};
    }
    device::DeviceHealth health() override {
        const device::DeviceStatus* status = station_.mover_status();
        return status != nullptr ? status->health : device::DeviceHealth{};
    }
    void permit_move() override {
        if (permission_) permission_->grant();
    }
    [[nodiscard]] const station::DeviceLayout& layout() const override { return station_.layout(); }
    [[nodiscard]] const servo::Setup& setup() const override { return station_.setup(); }
    const servo::Timing* stop() override {
        station_.stop();
        return &station_.servo().timing();
    }

  private:
    VirtualMover mover_;
    std::shared_ptr<device::MovePermission> permission_;  // null: the device never moves by itself
    station::Station station_;
};

// The time of the simulated arm advances with step().
class FrameSteppedStation final : public SteppedStation {
  public:
    explicit FrameSteppedStation(const device::Description& arm)
        : arm_(arm, device::simulated_arm_parameters(), device::virtual_timer(time_)) {}

    Status open(const station::StationOptions& options) {
        BOLT_TRY_ASSIGN(auto driver, arm_.factory()());
        driver_ = std::move(driver);
        BOLT_TRY_ASSIGN(auto layout, station::make_layout(options, driver_->description(), {}));
        layout_ = std::move(layout);
        return_time_ = layout_.workspace.return_time;
        setup_ = options.make_setup(station::limits_of(layout_), 1.0 / options.servo.rate);
        BOLT_TRY_ASSIGN(auto state, options.make_state(setup_));
        servo_ = std::move(state);
        state_ = station::initial_state(layout_);
        controls_ = options.controls;
        snapshot_.connection_number = 1;
        snapshot_.usable = true;
        if (options.hand) glove_ = WornGlove::start(options.glove, options.hand->wearer);
        return {};
    }

    void set_hand_motion(const device::HandMotion& motion) override { arm_.set_motion(motion); }
    void change_arm(const device::Description& arm, bool returns_offset) override {
        // The arms differ in what they sense, not in their limits, so the setup of the servo stays valid.
        device::Description changed = arm;
        changed.limits = layout_.mover->limits;
        layout_.mover = std::move(changed);
        layout_.workspace.return_time =
            returns_offset ? return_time_ : std::numeric_limits<double>::infinity();
        state_.gripper = {};
    }
    void step(double seconds) override {
        if (glove_) glove_->update();
        run_ticks(seconds);
    }
    [[nodiscard]] std::uint64_t lost_ticks() const override { return 0; }
    const station::DisplayedHand* hand() override { return nullptr; }
    const WornFingers* worn_fingers() override { return glove_ ? &glove_->fingers() : nullptr; }
    std::vector<std::string> fault_messages() override {
        return glove_ ? glove_->fault_messages() : std::vector<std::string>();
    }
    const servo::Timing* stop() override { return nullptr; }

  private:
    void read_devices(double now, station::StationInputs& inputs) override {
        while (time_.now < now)
            if (auto sample = driver_->read(now - time_.now); sample && *sample) {
                snapshot_.sample = **sample;
                ++snapshot_.number;
            }
        inputs.mover = snapshot_;
    }
    void write_devices(station::StationStep& done) override {
        // The simulated arm takes every command.
        (void)driver_->write(done.commands.mover);
    }

    double return_time_ = 0.0;  // s, WorkspaceMap::return_time of the arm that was opened
    device::VirtualTime time_;
    device::SimulatedArm arm_;
    std::unique_ptr<device::DeviceDriver> driver_;
    device::DeviceSnapshot snapshot_;
    std::optional<WornGlove> glove_;
};

}  // namespace

Result<std::unique_ptr<LessonStation>> start_threaded_station(
    station::StationOptions options, VirtualMover mover, std::shared_ptr<device::MovePermission> permission) {
    BOLT_TRY_ASSIGN(auto station, station::Station::start(std::move(options)));
    return std::make_unique<ThreadedStation>(std::move(station), std::move(mover), std::move(permission));
}

Result<std::unique_ptr<LessonStation>> start_frame_stepped_station(const station::StationOptions& options,
                                                                   const device::Description& arm) {
    auto station = std::make_unique<FrameSteppedStation>(arm);
    BOLT_TRY(station->open(options));
    return std::unique_ptr<LessonStation>(std::move(station));
}

}  // namespace bolt::station_setup
