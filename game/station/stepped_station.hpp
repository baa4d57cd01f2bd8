// A lesson's station without threads: its ticks run in the time that its owner gives it, so that no tick is
// missed on a busy computer, and the same input gives the same lesson.
#pragma once

#include <deque>
#include <vector>

#include "game/station/lesson_station.hpp"

namespace bolt::station_setup {

// A derived class connects the devices.
class SteppedStation : public LessonStation {
  public:
    void set_controls(const station::StationControls& controls) override { controls_ = controls; }
    Status send(const station::StationCommand& command) override {
        commands_.push_back(command);
        return {};
    }
    bool next_tick(station::StationTick& tick) override;
    const station::StationTick& latest_tick() override { return latest_; }
    [[nodiscard]] const station::DeviceLayout& layout() const override { return layout_; }
    [[nodiscard]] const servo::Setup& setup() const override { return setup_; }

  protected:
    // Runs the ticks of the next `seconds`. Set layout_, setup_, servo_ and state_ before the first call.
    void run_ticks(double seconds);
    // Advances the devices to `now`, s of ticks since the start, and writes their samples into `inputs`.
    virtual void read_devices(double now, station::StationInputs& inputs) = 0;
    // Writes the commands of `done` to the devices. A test may change the tick in `done`.
    virtual void write_devices(station::StationStep& done) = 0;

    station::DeviceLayout layout_;
    servo::Setup setup_;
    servo::State servo_;
    station::StationState state_;
    station::StationControls controls_;

  private:
    void tick();

    std::vector<station::StationCommand> commands_;  // of the next tick
    std::deque<station::StationTick> ticks_;         // that were not read yet
    station::StationTick latest_;
    double now_ = 0.0, unstepped_time_ = 0.0;  // s; unstepped_time_: time for which no tick has run yet
    std::uint64_t number_ = 0;
};

}  // namespace bolt::station_setup
