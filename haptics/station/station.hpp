// A running station: the threads of its devices, its glove and its servo. Other threads read its state and
// send controls and commands; none of these calls delays a tick.
#pragma once

#include <algorithm>
#include <filesystem>

#include "haptics/hand/glove_driver.hpp"
#include "haptics/servo/servo_thread.hpp"
#include "haptics/station/gloved_hand.hpp"
#include "haptics/station/station_tick.hpp"

namespace bolt::station {

// Statistics of the data between a device and the servo, updated after each tick of the servo.
struct LinkStats {
    // Samples after the first, including those replaced before a tick read them.
    std::uint64_t samples = 0;
    double silence = 0.0, longest_silence = 0.0;       // s since the last valid sample
    double largest_force = 0.0, largest_torque = 0.0;  // N, N·m, sent to the device
    std::uint64_t first = 0;  // number of the first sample that a tick received; 0: none yet
};

// Call after each tick with the device's link and the command that was sent.
inline void record_tick(LinkStats& stats, const DeviceLink& link, const force::OutputCommand& sent) {
    if (stats.first == 0) stats.first = link.number;
    stats.samples = link.number - stats.first;
    stats.silence = link.silence;
    stats.longest_silence = std::max(stats.longest_silence, link.silence);
    stats.largest_force = std::max(stats.largest_force, glm::length(sent.force));
    stats.largest_torque = std::max(stats.largest_torque, glm::length(sent.torque));
}

struct StationLinkStats {
    LinkStats mover, wheel;
};

// The part of the mapping from the mover's workspace to the assembly's that the installer determines.
struct WorkspaceOptions {
    // Unit, from the device's frame to the user's. The identity, unless the device is mounted at an angle
    // that its maker did not intend.
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    std::optional<double> scale;  // m of the tool per m of the device; none: fitted to the mover's reach
    // Power at the device / power at the tool (force::WorkspaceMap); none: 1/scale, so that forces keep their
    // magnitude.
    std::optional<double> power_ratio;
    // True: the mapping is absolute (the device's frame is the assembly's), and an offset between tool and
    // hand decays to 0 (WorkspaceMap::return_time). False: it is relative.
    bool absolute = false;
};

struct StationOptions {
    device::DeviceFactory mover, wheel;  // empty: no such device
    Buttons mover_buttons, wheel_buttons;
    WorkspaceOptions workspace;
    force::LimitBounds mover_limit_bounds;  // upper bounds on the limits that the mover reports
    double handle_length = 0.0;             // m, of the longest tool; fits the scale of an arm
    Pose home;                              // initial pose of the tool in the assembly's frame
    std::filesystem::path glove;            // serial port; empty: no glove
    std::optional<HandSetup> hand;          // wearer of the glove; none: the controls determine the grip
    double open_timeout = 3.0;              // s, per device, excluding its preparation
    // Called by start(); empty: a device that needs preparation is an error.
    device::PreparationHandler on_preparation;
    device::DeviceThreadOptions device_threads{{}, 70};  // priority below the servo's
    StationControls controls;                            // initial
    servo::ThreadOptions servo;
    // Build the servo's setup from the devices' limits and dt, and its initial state.
    std::function<servo::Setup(const force::OutputLimits& limits, double dt)> make_setup;
    std::function<Result<servo::State>(const servo::Setup& setup)> make_state;  // empty: servo::initial_state
};

// The layout of these devices: workspace and lever arm from the options, or fitted to the devices. The
// mover's limits are lowered to `mover_limit_bounds` first. Fails if there is no device or a device cannot
// take its role.
Result<DeviceLayout> make_layout(const StationOptions& options, std::optional<device::Description> mover,
                                 std::optional<device::Description> wheel);

class Station {
  public:
    // Opens the devices and starts the threads. Fails if a device does not open in time, cannot take its
    // role, or a thread cannot be created. A device that is lost later is reopened in the background.
    static Result<Station> start(StationOptions options);

    Station(Station&&) noexcept;
    Station& operator=(Station&&) noexcept;
    ~Station();  // stops; the devices are left at zero force

    // Call each of the following from one thread only. Call latest_tick() and fault_messages() from the same
    // thread, because both update the same buffer.
    void set_controls(const StationControls& controls);
    // Queues a command for the next tick. Fails if the queue is full, which means that the servo thread does
    // not run; the command is then not queued.
    [[nodiscard]] Status send(const StationCommand& command);
    const StationTick& latest_tick();
    // Writes the next tick, in order and without the ticks of a pause; returns false if there is none yet.
    bool next_tick(StationTick& tick);
    [[nodiscard]] std::uint64_t lost_ticks() const;  // not read in time and dropped

    // The gloved hand for display; null: none. Call it from one thread only.
    const DisplayedHand* hand();

    // Messages on present faults of mover, wheel, output and glove, in this order, at most 0.1 s old.
    std::vector<std::string> fault_messages();

    // Reports of the devices and the glove, null if absent, and the link statistics of the latest tick. For
    // the thread that calls fault_messages().
    const device::DeviceStatus* mover_status();
    const device::DeviceStatus* wheel_status();
    const hand::GloveReport* glove_report();
    const StationLinkStats& link_stats();

    [[nodiscard]] const DeviceLayout& layout() const;
    // While the servo runs, do not read what servo::change_tool() changes: `tool`, `wrench` and the nuts'
    // grip heights.
    [[nodiscard]] const servo::Setup& setup() const;
    [[nodiscard]] hand::GloveDriver* glove();  // null: no glove, or a gloved hand uses it
    [[nodiscard]] servo::ServoThread& servo();
    // Stops the servo. The device threads then release the forces, because they get no more commands.
    void stop();

  private:
    struct Shared;
    explicit Station(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::station
