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
    // Runs the ticks of that time, s. The layout, the setup and both states must have been set.
    void run_ticks(double seconds);
    // Serves the devices until `now`, s of ticks since the start, and fills in their samples.
    virtual void read_devices(double now, station::StationInputs& inputs) = 0;
    // Takes the commands for the devices. A test may change the tick.
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
    double now_ = 0.0, owed_ = 0.0;  // s
    std::uint64_t number_ = 0;
};

}  // namespace bolt::station_setup
