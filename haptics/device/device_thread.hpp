// Runs a device on its own thread. Mailboxes exchange the latest command and the latest sample with the
// servo, so the servo never waits for a device.
#pragma once

#include <atomic>

#include "engine/base/triple_buffer.hpp"
#include "haptics/device/supervisor.hpp"

namespace bolt::device {

// The device as the servo sees it.
struct DeviceSnapshot {
    Sample sample;              // the latest valid sample
    std::uint64_t number = 0;   // count of samples; 0: none yet
    std::uint64_t opening = 0;  // count of openings; if it changes, the pose may jump
    bool usable = false;        // false: the sample is stale
};

struct DeviceMailboxes {
    TripleBuffer<ForceCommand> commands;
    TripleBuffer<DeviceSnapshot> snapshots;
    TripleBuffer<DeviceReport> reports;
};

// Polls the supervisor once and updates the mailboxes. The thread repeats it; tests call it in virtual time.
// `snapshot` is the last published one.
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

    // Never wait. One calling thread each: the servo's.
    void command(const force::OutputCommand& command, bool enabled);
    const DeviceSnapshot& snapshot();

    // At most 0.1 s old. One calling thread, not necessarily the servo's.
    const DeviceReport& report();

    // s since the driver's last call returned. A driver that hangs cannot update its report.
    [[nodiscard]] double blocked_for() const;

    // Waits until the device is open and returns its description; after `timeout` s the error says why it is
    // not. Reads report(), so call it from the same thread.
    Result<std::shared_ptr<const Description>> wait_until_open(double timeout);

  private:
    struct Shared;
    explicit DeviceThread(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::device
