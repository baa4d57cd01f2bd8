// The interface between a lesson and its station. start_bench() returns one that runs on its own threads;
// tests implement one in virtual time.
#pragma once

#include "haptics/device/virtual_devices.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station_setup {

class Bench {
  public:
    Bench() = default;
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;
    virtual ~Bench() = default;

    virtual void set_controls(const station::StationControls& controls) = 0;
    // Fails if the command queue is full (station::Station::send).
    [[nodiscard]] virtual Status send(const station::StationCommand& command) = 0;
    // Rates from mouse and keyboard if no device moves the tool; call it every frame.
    virtual void push(const device::PuckInput& push) = 0;
    virtual bool next_tick(station::TickRecord& tick) = 0;       // all ticks in order; false: no more yet
    virtual const station::TickRecord& latest_tick() = 0;        // in a pause too
    [[nodiscard]] virtual std::uint64_t lost_ticks() const = 0;  // not read in time and dropped
    virtual const station::DisplayedHand* hand() = 0;            // null: no gloved hand
    virtual std::vector<std::string> troubles() = 0;

    [[nodiscard]] virtual const station::Layout& layout() const = 0;
    [[nodiscard]] virtual const servo::Setup& setup() const = 0;

    // Stops the station at zero force. Returns the timing of its servo thread, null if it has none.
    virtual const servo::Timing* stop() = 0;
};

// Starts the station. `puck` receives push() and moves the tool if no device does.
Result<std::unique_ptr<Bench>> start_bench(station::StationOptions options,
                                           std::optional<device::VirtualPuck> puck);

}  // namespace bolt::station_setup
