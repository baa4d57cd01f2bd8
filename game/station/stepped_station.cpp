#include "game/station/stepped_station.hpp"

namespace bolt::station_setup {

bool SteppedStation::next_tick(station::StationTick& tick) {
    if (ticks_.empty()) return false;
    tick = ticks_.front();
    ticks_.pop_front();
    return true;
}

void SteppedStation::run_ticks(double seconds) {
    for (unstepped_time_ += seconds; unstepped_time_ >= setup_.dt; unstepped_time_ -= setup_.dt) tick();
}

void SteppedStation::tick() {
    now_ += setup_.dt;
    station::StationInputs inputs;
    inputs.controls = controls_;
    inputs.commands = commands_;
    read_devices(now_, inputs);
    station::StationStep done = station::step(layout_, setup_, state_, servo_, inputs, ++number_);
    commands_.clear();
    write_devices(done);
    latest_ = done.tick;
    if (!done.paused) ticks_.push_back(latest_);
}

}  // namespace bolt::station_setup
