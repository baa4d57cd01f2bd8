// The interface between a lesson and its station, and the two stations: one on threads, one whose ticks run
// with the frames.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "game/station/worn_glove.hpp"
#include "haptics/device/preparation.hpp"
#include "haptics/device/simulated_arm.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "haptics/station/gloved_hand.hpp"
#include "haptics/station/station.hpp"

namespace bolt::station_setup {

// A station as a lesson uses it. start_threaded_station() returns one that runs on its own threads,
// start_frame_stepped_station() one whose ticks run in step().
class LessonStation {
  public:
    LessonStation() = default;
    LessonStation(const LessonStation&) = delete;
    LessonStation& operator=(const LessonStation&) = delete;
    virtual ~LessonStation() = default;

    // Sets the controls of the ticks from now on. Call it once a frame, because StationControls::dead_man
    // expires.
    virtual void set_controls(const station::StationControls& controls) = 0;
    // Fails if the command queue is full (station::Station::send).
    [[nodiscard]] virtual Status send(const station::StationCommand& command) = 0;
    // The input of a virtual puck, and of the hand that moves a simulated arm; call it every frame. Ignored
    // if the station has no such mover.
    virtual void set_puck_input(const device::PuckInput& /*input*/) {}
    virtual void set_hand_motion(const device::HandMotion& /*motion*/) {}
    // From now on another hand moves the simulated arm: `arm` as in start_frame_stepped_station().
    // `returns_offset`: an offset between tool and hand decays to 0; false: it remains. Ignored by stations
    // on threads.
    virtual void change_arm(const device::Description& /*arm*/, bool /*returns_offset*/) {}
    // Call once a frame with the time since the last one, s. Runs the ticks of that time if the station has
    // no threads.
    virtual void step(double /*seconds*/) {}
    // Reads the next tick in order; false: there is none yet.
    virtual bool next_tick(station::StationTick& tick) = 0;
    virtual const station::StationTick& latest_tick() = 0;       // is updated in a pause too
    [[nodiscard]] virtual std::uint64_t lost_ticks() const = 0;  // dropped because they were not read in time
    virtual const station::DisplayedHand* hand() = 0;            // null: no gloved hand at an arm
    // The fingers of a glove whose wrist a headset measures; null: there is no such glove.
    virtual const WornFingers* worn_fingers() { return nullptr; }
    virtual std::vector<std::string> fault_messages() = 0;  // present faults of devices and glove
    // After the device that moves the tool was lost: its needs before it can be opened again.
    virtual device::ArmNeeds needs() { return {}; }
    virtual device::DeviceHealth health() { return {}; }  // of the device that moves the tool
    // Permits that device to move by itself at its next opening (device::MovePermission).
    virtual void permit_move() {}

    [[nodiscard]] virtual const station::DeviceLayout& layout() const = 0;
    [[nodiscard]] virtual const servo::Setup& setup() const = 0;

    // Stops the station at zero force. Returns the timing of its servo thread, null if it has none.
    virtual const servo::Timing* stop() = 0;
};

// The virtual device that mouse and keyboard move if no device moves the tool; monostate: none.
using VirtualMover = std::variant<std::monostate, device::VirtualPuck, device::SimulatedArm>;

// Starts the station on its own threads. `permission`: of the device that moves the tool; may be null.
Result<std::unique_ptr<LessonStation>> start_threaded_station(
    station::StationOptions options, VirtualMover mover,
    std::shared_ptr<device::MovePermission> permission = {});

// Starts a SteppedStation with a simulated arm, whose time advances with step(). `arm`:
// device::simulated_arm_description() or device::tracked_hand_description(). With StationOptions::hand the
// wearer's fingers are read each frame (LessonStation::worn_fingers).
Result<std::unique_ptr<LessonStation>> start_frame_stepped_station(const station::StationOptions& options,
                                                                   const device::Description& arm);

}  // namespace bolt::station_setup
