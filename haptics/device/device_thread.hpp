// Runs a device on its own thread. A supervisor keeps it usable; mailboxes exchange the latest command and
// the latest sample with the servo, so the servo never waits for a device.
#pragma once

#include <atomic>
#include <cstdint>

#include "engine/base/function_ref.hpp"
#include "engine/base/lock_free.hpp"
#include "haptics/device/device.hpp"
#include "haptics/device/preparation.hpp"

namespace bolt::device {

struct SupervisorOptions {
    double first_retry_delay = 0.05, max_retry_delay = 1.0;  // s between attempts to open; the delay doubles
    // s without a new command until the force is released. The poll (2 ms) that notices it and the write
    // come after that, so the device has released its force after 20 ms at the latest.
    double command_timeout = 0.015;
    double max_silence = 0.25;  // s without a valid sample until the silence is reported
    double reopen_after = 1.0;  // s of silence until the device is reopened
};

// The force to render. Commands issued before the device was opened are never rendered.
struct ForceCommand {
    force::OutputCommand command;
    bool enabled = false;      // false: the device renders no force
    std::uint64_t number = 0;  // a new number marks a new command
};

enum class DeviceState : std::uint8_t {
    absent,  // not open
    silent,  // open, but sends no valid samples
    usable,
};

struct DeviceStatus {
    DeviceState state = DeviceState::absent;
    std::string fault_message;                        // plain text; empty: none
    Preparation preparation;                          // action needed before the device can be opened
    DeviceHealth health;                              // while open
    std::shared_ptr<const Description> description;   // from the last opening; null: never opened
    std::uint64_t openings = 0, failed_openings = 0;  // successful and failed attempts to open
    std::uint64_t losses = 0;                         // closed after a read or write error
    std::uint64_t silence_timeouts = 0;               // closed after reopen_after s of silence
    std::uint64_t samples = 0, malformed_samples = 0;
    std::uint64_t writes = 0;
    double write_time = 0.0, longest_write = 0.0;  // s that the driver took for writes
    std::uint64_t command_timeouts = 0;            // command timeouts while a force was rendered
};

// Keeps one device usable: opens it, reopens it with exponential backoff after a loss or silence, reports the
// problem in plain text, and releases the force when commands stop. It acts only through device and timer, so
// that tests run it in virtual time; DeviceThread runs it on a thread.
class DeviceSupervisor {
  public:
    DeviceSupervisor(DeviceFactory open, Timer timer, const SupervisorOptions& options = {});
    DeviceSupervisor(const DeviceSupervisor&) = delete;
    DeviceSupervisor& operator=(const DeviceSupervisor&) = delete;
    ~DeviceSupervisor();  // closes the device

    // Waits a few milliseconds at most for a sample or for the next attempt to open, then writes the command
    // that `latest_command` returns. nullopt: no new valid sample.
    std::optional<Sample> poll(FunctionRef<ForceCommand()> latest_command);

    // Releases the force if possible and closes the device.
    void close();

    [[nodiscard]] const DeviceStatus& status() const { return status_; }

  private:
    bool try_open(std::uint64_t number);
    Status write(const ForceCommand& requested, double now);
    void handle_loss(const Error& error);
    void track_silence(bool received, double now);
    [[nodiscard]] bool is_valid(const Sample& sample) const;
    [[nodiscard]] bool expects_samples() const;

    DeviceFactory open_;
    Timer timer_;
    SupervisorOptions options_;
    DeviceStatus status_;
    std::unique_ptr<DeviceDriver> device_;
    double read_timeout_ = 0.0;
    double retry_delay_ = 0.0, next_try_ = 0.0;  // s
    double last_sample_ = 0.0;                   // time of the last valid sample
    std::uint64_t command_number_ = 0;           // of the newest command
    double command_time_ = 0.0;                  // when that command was first seen
    bool rendering_ = false;                     // the last write was not zero
    // The device may still hold a force: no zero command has been written since the opening, or since the
    // last rendered force.
    bool may_hold_force_ = false;
};

// The device as the servo sees it.
struct DeviceSnapshot {
    Sample sample;                        // the latest valid sample
    std::uint64_t number = 0;             // count of samples; 0: none yet
    std::uint64_t connection_number = 0;  // count of openings; if it changes, the pose may jump
    bool usable = false;                  // false: the sample is stale
};

struct DeviceMailboxes {
    TripleBuffer<ForceCommand> commands;
    TripleBuffer<DeviceSnapshot> snapshots;
    TripleBuffer<DeviceStatus> statuses;
};

// Polls the supervisor once and updates the mailboxes. DeviceThread repeats this call; tests make it in
// virtual time. `snapshot` is the last published snapshot.
void run_once(DeviceSupervisor& supervisor, DeviceMailboxes& mailboxes, DeviceSnapshot& snapshot);

struct DeviceThreadOptions {
    SupervisorOptions supervisor;
    int priority = 0;  // SCHED_FIFO priority 1 … 99 if permitted; 0: default scheduling
};

class DeviceThread {
  public:
    // Returns immediately. The thread opens the device and reopens it after a loss.
    static Result<DeviceThread> start(DeviceFactory open, const DeviceThreadOptions& options = {});

    DeviceThread(DeviceThread&&) noexcept;
    DeviceThread& operator=(DeviceThread&&) noexcept;
    ~DeviceThread();  // joins; the device is closed without force

    // For the servo thread; wait-free.
    void command(const force::OutputCommand& command, bool enabled);
    const DeviceSnapshot& snapshot();

    // At most 0.1 s old. Call it from one thread only, not necessarily the servo's.
    const DeviceStatus& status();

    // s since the driver's last call returned. While a driver hangs, status() is not updated.
    [[nodiscard]] double blocked_for() const;

    // Waits until the device is open and returns its description; fails with the reason after `timeout` s.
    // The timeout starts again while the device needs a preparation and `on_preparation` returns true. Call
    // from the thread that reads status().
    Result<std::shared_ptr<const Description>> wait_until_open(double timeout,
                                                               const PreparationHandler& on_preparation = {});

  private:
    struct Shared;
    explicit DeviceThread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::device
